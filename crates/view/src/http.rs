//! As much of HTTP as a page needs: one request on a connection, answered and closed.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Longest head of a request [bytes].
const HEAD_MAX: usize = 16 * 1024;
const HEADERS_MAX: usize = 64;
/// How long a client may take to say what it wants.
const PATIENCE: Duration = Duration::from_secs(10);
/// How long it may take to send a file.
const BODY_PATIENCE: Duration = Duration::from_secs(60);

/// The head of a request.
#[derive(Clone, Debug, Default)]
pub struct Request {
    pub method: String,
    pub path: String,
    /// Behind the question mark.
    pub query: String,
    headers: Vec<(String, String)>,
    /// What came after the head.
    pub rest: Vec<u8>,
}

/// A request that is not answered with what it asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rejection {
    pub status: u16,
    pub message: String,
}

impl Rejection {
    pub fn new(status: u16, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }
}

impl Request {
    /// Reads the head; `None` where the client went away or was silent.
    ///
    /// # Errors
    /// It is no request, or too long.
    pub fn read(stream: &mut TcpStream) -> Result<Option<Self>, Rejection> {
        let deadline = Instant::now() + PATIENCE;
        let mut bytes = Vec::new();
        let mut buffer = [0; 4096];
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
                return Ok(None);
            }
            match stream.read(&mut buffer) {
                Ok(0) => return Ok(None),
                Ok(count) => bytes.extend_from_slice(&buffer[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(_) => return Ok(None),
            }
            if let Some(request) = Self::parse(&bytes)? {
                return Ok(Some(request));
            }
            if bytes.len() > HEAD_MAX {
                return Err(Rejection::new(431, format!("the head is longer than {HEAD_MAX} bytes")));
            }
        }
    }

    /// `None`: the head is not complete.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Option<Self>, Rejection> {
        let mut headers = [httparse::EMPTY_HEADER; HEADERS_MAX];
        let mut head = httparse::Request::new(&mut headers);
        let wrong = |error: httparse::Error| Rejection::new(400, format!("this is no request: {error}"));
        let httparse::Status::Complete(length) = head.parse(bytes).map_err(wrong)? else { return Ok(None) };
        let target = head.path.unwrap_or_default();
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let text = |header: &httparse::Header| {
            (header.name.to_ascii_lowercase(), String::from_utf8_lossy(header.value).into_owned())
        };
        Ok(Some(Self {
            method: head.method.unwrap_or_default().to_owned(),
            path: path.to_owned(),
            query: query.to_owned(),
            headers: head.headers.iter().map(text).collect(),
            rest: bytes[length..].to_vec(),
        }))
    }

    /// The first header of a name in small letters.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// Whether a header lists a word.
    pub fn header_has(&self, name: &str, word: &str) -> bool {
        self.header(name)
            .is_some_and(|value| value.split(',').any(|part| part.trim().eq_ignore_ascii_case(word)))
    }

    /// A value of the query, as forms write it.
    pub fn query_value(&self, name: &str) -> Option<String> {
        let mut pairs = form_urlencoded::parse(self.query.as_bytes());
        pairs.find(|(key, _)| key == name).map(|(_, value)| value.into_owned())
    }

    /// Reads what comes after the head, of the length that it says.
    ///
    /// # Errors
    /// No length, one beyond `most`, or a client that does not send so much.
    pub fn body(&mut self, stream: &mut TcpStream, most: usize) -> Result<Vec<u8>, Rejection> {
        let length = self.header("content-length").and_then(|text| text.trim().parse::<usize>().ok());
        let length = length.ok_or_else(|| Rejection::new(411, "there is no Content-Length"))?;
        if length > most {
            return Err(Rejection::new(
                413,
                format!("{length} bytes are more than the {most} that are taken"),
            ));
        }
        let mut body = std::mem::take(&mut self.rest);
        let deadline = Instant::now() + BODY_PATIENCE;
        let mut buffer = vec![0; 64 * 1024];
        while body.len() < length {
            let left = deadline.saturating_duration_since(Instant::now());
            let cut_off = || Rejection::new(400, "the file broke off");
            if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
                return Err(cut_off());
            }
            match stream.read(&mut buffer) {
                Ok(0) => return Err(cut_off()),
                Ok(count) => body.extend_from_slice(&buffer[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(_) => return Err(cut_off()),
            }
        }
        body.truncate(length);
        Ok(body)
    }
}

/// What is sent back.
pub struct Response<'a> {
    pub status: u16,
    pub kind: &'a str,
    pub content: &'a [u8],
    /// The name under which a browser is to save it.
    pub save_as: Option<&'a str>,
}

fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        400 => "Bad Request",
        401 => "Unauthorized",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        411 => "Length Required",
        413 => "Content Too Large",
        426 => "Upgrade Required",
        431 => "Request Header Fields Too Large",
        _ => "Service Unavailable",
    }
}

impl Response<'_> {
    /// # Errors
    /// The client does not take it.
    pub fn send(&self, stream: &mut TcpStream, method: &str) -> io::Result<()> {
        let Self { status, kind, content, save_as } = self;
        let disposition = save_as.map_or_else(String::new, |name| {
            format!("Content-Disposition: attachment; filename=\"{name}\"\r\n")
        });
        // nothing of a page may come from elsewhere, and no other page may hold it
        let head = format!(
            "HTTP/1.1 {status} {}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{disposition}\
             Connection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n\
             Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
             Content-Security-Policy: default-src 'self'; style-src 'self' 'unsafe-inline'; \
             img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\r\n",
            reason(*status),
            content.len()
        );
        stream.set_write_timeout(Some(PATIENCE))?;
        stream.write_all(head.as_bytes())?;
        if method != "HEAD" {
            stream.write_all(content)?;
        }
        stream.flush()
    }
}

impl Rejection {
    /// # Errors
    /// The client does not take it.
    pub fn send(&self, stream: &mut TcpStream) -> io::Result<()> {
        let content = format!("{}\n", self.message);
        let kind = "text/plain; charset=utf-8";
        Response { status: self.status, kind, content: content.as_bytes(), save_as: None }.send(stream, "GET")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_read() {
        let text = b"GET /socket?a=b&token=xyz HTTP/1.1\r\nHost: here\r\nConnection: keep-alive, Upgrade\r\n\r\nrest";
        let request = Request::parse(text).unwrap().unwrap();
        assert_eq!((request.method.as_str(), request.path.as_str()), ("GET", "/socket"));
        assert_eq!(request.query_value("token").as_deref(), Some("xyz"));
        assert_eq!(request.header("host"), Some("here"));
        assert!(request.header_has("connection", "upgrade"));
        assert_eq!(request.rest, b"rest");
        assert!(Request::parse(&text[..20]).unwrap().is_none());
        assert_eq!(Request::parse(b"\x16\x03\x01\x02\x00\x01").unwrap_err().status, 400);
    }
}
