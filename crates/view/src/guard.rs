//! Who may talk to the server: pages it served itself, and beyond this machine only who knows the token.

use std::net::{IpAddr, SocketAddr, UdpSocket};

use crate::http::{Rejection, Request};

/// What is asked of clients.
pub struct Guard {
    /// Where others find the server.
    address: SocketAddr,
    /// Asked for beyond loopback.
    token: Option<String>,
}

/// Bytes of a token: nobody guesses 128 bits.
const TOKEN_BYTES: usize = 16;

impl Guard {
    /// # Errors
    /// The system gives no random numbers for a token.
    pub fn new(address: SocketAddr) -> Result<Self, getrandom::Error> {
        let token = if address.ip().is_loopback() { None } else { Some(new_token()?) };
        let ip = if address.ip().is_unspecified() { outward(address.ip()) } else { address.ip() };
        Ok(Self { address: SocketAddr::new(ip, address.port()), token })
    }

    /// Where a person finds the page.
    pub fn address(&self) -> String {
        match &self.token {
            Some(token) => format!("http://{}/?token={token}", self.address),
            None => format!("http://{}/", self.address),
        }
    }

    /// Refuses other sites: those that a browser names as the origin, and those whose name was made to lead here.
    ///
    /// # Errors
    /// Says what would be let in.
    pub fn check_site(&self, request: &Request) -> Result<(), Rejection> {
        let host = request.header("host").unwrap_or_default();
        if self.token.is_none() && !is_own_host(host, self.address.port()) {
            let message = format!("the host `{host}` is not this server; ask for http://{}/", self.address);
            return Err(Rejection::new(403, message));
        }
        // a picture or a script of another site asks without an origin; a link leads to the page alone
        let site = request.header("sec-fetch-site").unwrap_or("none");
        if request.path != "/" && !matches!(site, "none" | "same-origin") {
            return Err(Rejection::new(403, "this is for the page of this server alone"));
        }
        match request.header("origin") {
            Some(origin) if origin != format!("http://{host}") => {
                // never the token: who asks may not know it
                let message = format!("pages of `{origin}` may not come here; open http://{}/", self.address);
                Err(Rejection::new(403, message))
            }
            _ => Ok(()),
        }
    }

    /// Refuses who does not know the token, where one is asked for.
    ///
    /// # Errors
    /// The token is missing or wrong.
    pub fn check_token(&self, request: &Request) -> Result<(), Rejection> {
        let Some(token) = &self.token else { return Ok(()) };
        let given = request.query_value("token").unwrap_or_default();
        // every byte is looked at, so that time tells nothing
        let differs = token.bytes().zip(given.bytes()).fold(0, |sum, (a, b)| sum | (a ^ b));
        if given.len() == token.len() && differs == 0 {
            return Ok(());
        }
        Err(Rejection::new(401, "the token is missing or wrong; use the address that `souple view` printed"))
    }
}

/// The address of this machine that others see of those it listens on, or its own for itself where it has none. Nothing is
/// sent: the system chooses the address from which it would send to a place kept for documentation (RFC 5737, RFC 3849).
fn outward(any: IpAddr) -> IpAddr {
    let (place, own) = match any {
        IpAddr::V4(_) => ("192.0.2.1:9", IpAddr::from([127, 0, 0, 1])),
        IpAddr::V6(_) => ("[2001:db8::1]:9", IpAddr::from([0, 0, 0, 0, 0, 0, 0, 1])),
    };
    let chosen = UdpSocket::bind((any, 0)).and_then(|socket| {
        socket.connect(place)?;
        socket.local_addr()
    });
    chosen.map(|chosen| chosen.ip()).ok().filter(|ip| !ip.is_unspecified()).unwrap_or(own)
}

/// Whether a host is a name of this machine for itself, with the server's port.
fn is_own_host(host: &str, port: u16) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, given)) if !given.ends_with(']') => {
            if given.parse() != Ok(port) {
                return false;
            }
            name
        }
        _ if port == 80 => host,
        _ => return false,
    };
    let is_address = name.parse().is_ok_and(|ip: std::net::Ipv4Addr| ip.is_loopback());
    name.eq_ignore_ascii_case("localhost") || name == "[::1]" || is_address
}

fn new_token() -> Result<String, getrandom::Error> {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_hosts() {
        for host in ["127.0.0.1:7878", "localhost:7878", "LOCALHOST:7878", "[::1]:7878", "127.1.2.3:7878"] {
            assert!(is_own_host(host, 7878), "{host}");
        }
        for host in
            ["evil.example:7878", "127.0.0.1", "127.0.0.1:80", "", "localhost.evil.example:7878", "[::1]"]
        {
            assert!(!is_own_host(host, 7878), "{host}");
        }
    }

    #[test]
    fn tokens_are_asked_for_beyond_this_machine() {
        assert_eq!(Guard::new(([127, 0, 0, 1], 1).into()).unwrap().address(), "http://127.0.0.1:1/");
        let open = Guard::new(([0, 0, 0, 0], 1).into()).unwrap();
        let (_, token) =
            open.address().split_once("token=").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
        assert_eq!(token.len(), 2 * TOKEN_BYTES);
        // a browser cannot ask for all addresses
        assert!(!open.address().contains("//0.0.0.0"), "{}", open.address());
        let head = b"GET / HTTP/1.1\r\nHost: here:1\r\nOrigin: http://evil.example\r\n\r\n";
        let foreign = Request::parse(head).unwrap().unwrap();
        let head = b"GET /recording HTTP/1.1\r\nHost: here:1\r\nSec-Fetch-Site: cross-site\r\n\r\n";
        let embedded = Request::parse(head).unwrap().unwrap();
        assert_eq!(open.check_site(&embedded).unwrap_err().status, 403);
        let refused = open.check_site(&foreign).unwrap_err();
        assert!(refused.status == 403 && !refused.message.contains(&token), "{}", refused.message);
        let asking = |query: &str| {
            let mut request = Request::default();
            query.clone_into(&mut request.query);
            request
        };
        assert!(open.check_token(&asking(&format!("token={token}"))).is_ok());
        for query in ["", "token=", "token=00000000000000000000000000000000"] {
            assert_eq!(open.check_token(&asking(query)).unwrap_err().status, 401);
        }
    }
}
