//! A device at the other end of a socket: Open Sound Control over UDP, as instruments, motion trackers and drivers of devices
//! written in any language speak it.
//!
//! In comes `/souple/hand/position` with three floats [m], out goes `/souple/hand/force` with three floats [N] to whoever was
//! heard last, every tick. The first position heard is where the device starts.

use std::net::{Ipv4Addr, SocketAddr, UdpSocket};

use rosc::{OscMessage, OscPacket, OscType};
use souple_math::Vec3;

use crate::TICK;
use crate::device::Device;

pub const POSITION: &str = "/souple/hand/position";
pub const FORCE: &str = "/souple/hand/force";

/// A socket of this machine on which a device is heard.
#[derive(Debug)]
pub struct OscDevice {
    socket: UdpSocket,
    /// World per device: how much the motion is enlarged.
    scale: f64,
    /// Ticks of silence after which the device is lost.
    patience: u64,
    /// Who was heard last.
    peer: Option<SocketAddr>,
    /// Where it started, as it says.
    origin: Option<Vec3>,
    place: Vec3,
    /// Ticks since it was heard.
    silent: u64,
    refused: u64,
}

/// Packets heard in a tick at most: a flood is no reason to miss the next one.
const MOST_PACKETS: usize = 64;
/// Longest packet that is looked at [bytes].
const LONGEST: usize = 1536;

impl OscDevice {
    /// Listens on a port of this machine alone; 0 takes a free one.
    ///
    /// # Errors
    /// The port is taken.
    pub fn open(port: u16, scale: f64, patience: f64) -> std::io::Result<Self> {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, port))?;
        socket.set_nonblocking(true)?;
        Ok(Self {
            socket,
            scale,
            patience: (patience / TICK).ceil() as u64,
            peer: None,
            origin: None,
            place: Vec3::ZERO,
            silent: 0,
            refused: 0,
        })
    }

    /// Where it listens.
    ///
    /// # Errors
    /// The system does not tell.
    pub fn address(&self) -> std::io::Result<SocketAddr> {
        self.socket.local_addr()
    }

    fn is_lost(&self) -> bool {
        self.silent > self.patience || self.origin.is_none()
    }

    fn hear(&mut self) {
        let mut buffer = [0; LONGEST];
        self.silent += 1;
        for _ in 0..MOST_PACKETS {
            // nothing more to hear, or a peer that is gone, which is the same
            let Ok((length, peer)) = self.socket.recv_from(&mut buffer) else { break };
            match position_in(&buffer[..length]) {
                Some(place) => {
                    let origin = *self.origin.get_or_insert(place);
                    self.place = (place - origin) * self.scale;
                    self.peer = Some(peer);
                    self.silent = 0;
                }
                None => self.refused += 1,
            }
        }
    }
}

/// The position that a packet tells: the last of a bundle; `None` where it is none, or is not finite.
fn position_in(packet: &[u8]) -> Option<Vec3> {
    fn of(packet: OscPacket) -> Option<Vec3> {
        match packet {
            OscPacket::Message(message) if message.addr == POSITION => vector(&message.args),
            OscPacket::Message(_) => None,
            OscPacket::Bundle(bundle) => bundle.content.into_iter().rev().find_map(of),
        }
    }
    of(rosc::decoder::decode_udp(packet).ok()?.1)
}

fn vector(arguments: &[OscType]) -> Option<Vec3> {
    let number = |argument: &OscType| match argument {
        OscType::Float(number) => Some(f64::from(*number)),
        OscType::Double(number) => Some(*number),
        OscType::Int(number) => Some(f64::from(*number)),
        _ => None,
    };
    let [x, y, z] = arguments else { return None };
    Some(Vec3::new(number(x)?, number(y)?, number(z)?)).filter(|place| place.is_finite())
}

impl Device for OscDevice {
    fn place(&mut self) -> Option<Vec3> {
        self.hear();
        (!self.is_lost()).then_some(self.place)
    }

    fn give(&mut self, force: Vec3) {
        let Some(peer) = self.peer else { return };
        let force = if self.is_lost() { Vec3::ZERO } else { force };
        let args = force.to_array().map(|number| OscType::Float(number as f32)).to_vec();
        let message = OscPacket::Message(OscMessage { addr: FORCE.to_owned(), args });
        if let Ok(packet) = rosc::encoder::encode(&message) {
            // a peer that does not listen is found out by its silence
            let _ = self.socket.send_to(&packet, peer);
        }
    }

    fn refused(&self) -> u64 {
        self.refused
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    /// A client on a socket of its own.
    struct Client {
        socket: UdpSocket,
    }

    impl Client {
        fn of(device: &OscDevice) -> Self {
            let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a socket");
            socket.connect(device.address().expect("an address")).expect("a peer");
            socket.set_read_timeout(Some(Duration::from_secs(10))).expect("a timeout");
            Self { socket }
        }

        fn say(&self, address: &str, args: Vec<OscType>) {
            let message = OscPacket::Message(OscMessage { addr: address.to_owned(), args });
            self.socket.send(&rosc::encoder::encode(&message).expect("a packet")).expect("sent");
        }

        fn place(&self, place: [f32; 3]) {
            self.say(POSITION, place.map(OscType::Float).to_vec());
        }

        fn force(&self) -> Vec3 {
            let mut buffer = [0; LONGEST];
            let length = self.socket.recv(&mut buffer).expect("a force");
            let (_, packet) = rosc::decoder::decode_udp(&buffer[..length]).expect("a packet");
            let OscPacket::Message(message) = packet else { panic!("{packet:?}") };
            assert_eq!(message.addr, FORCE);
            vector(&message.args).expect("three numbers")
        }
    }

    /// Ticks until the device says what is asked for; packets of this machine take their time too.
    fn wait(device: &mut OscDevice, force: Vec3, until: impl Fn(&OscDevice, Option<Vec3>) -> bool) {
        let clock = Instant::now();
        loop {
            let place = device.place();
            device.give(force);
            if until(device, place) {
                return;
            }
            assert!(clock.elapsed() < Duration::from_secs(10), "{device:?}");
            std::thread::sleep(Duration::from_micros(100));
        }
    }

    /// Places come in from where the first one was, enlarged; forces go out to who was heard.
    #[test]
    fn places_in_forces_out() {
        let mut device = OscDevice::open(0, 2.0, 10.0).expect("a port");
        assert_eq!(device.place(), None);
        device.give(Vec3::X);
        let client = Client::of(&device);
        client.place([0.5, 0.0, 0.0]);
        wait(&mut device, Vec3::ZERO, |_, place| place == Some(Vec3::ZERO));
        client.place([0.75, 0.0, -0.25]);
        wait(&mut device, Vec3::new(0.5, 0.0, -1.0), |_, place| place == Some(Vec3::new(0.5, 0.0, -0.5)));
        // the last of them was sent with the place
        while client.force() != Vec3::new(0.5, 0.0, -1.0) {}
    }

    /// Noise, other messages and numbers that are none change nothing, and are counted.
    #[test]
    fn bad_packets() {
        let mut device = OscDevice::open(0, 1.0, 10.0).expect("a port");
        let client = Client::of(&device);
        client.place([0.0; 3]);
        client.place([0.25, 0.0, 0.0]);
        client.socket.send(&[0xff; 40]).expect("sent");
        client.socket.send(b"").expect("sent");
        client.say("/other", vec![OscType::Float(1.0)]);
        client.say(POSITION, vec![OscType::Float(1.0), OscType::Float(f32::NAN), OscType::Float(0.0)]);
        client.say(POSITION, vec![OscType::Float(1.0)]);
        client.say(POSITION, vec![OscType::String("x".to_owned()); 3]);
        wait(&mut device, Vec3::ZERO, |device, place| device.refused() == 6 && place == Some(Vec3::X * 0.25));
    }

    /// A device that is silent is lost, and found again when it speaks.
    #[test]
    fn silence_is_loss() {
        let mut device = OscDevice::open(0, 1.0, 5e-3).expect("a port");
        let client = Client::of(&device);
        client.place([0.0; 3]);
        wait(&mut device, Vec3::X, |_, place| place.is_some());
        wait(&mut device, Vec3::X, |_, place| place.is_none());
        client.place([0.0, 0.5, 0.0]);
        wait(&mut device, Vec3::X, |_, place| place == Some(Vec3::Y * 0.5));
    }
}
