//! The way in: what is sent to the world, and breaks off the step that goes on where it makes that pointless.

use std::sync::mpsc::{Receiver, RecvTimeoutError, SendError, SyncSender, TryRecvError, sync_channel};
use std::time::Duration;

use souple_engine::Interruption;

use super::compile::{Compiled, Purpose};
use super::question::{Answered, Question};
use crate::hub::PageId;
use crate::protocol::Wish;

/// What reaches the world from outside.
pub enum Input {
    Joined(PageId),
    Left(PageId),
    Said(PageId, Wish),
    Asked(Question, SyncSender<Answered>),
    Compiled(Box<Compiled>),
    Stop,
}

impl Input {
    /// Whether it goes before what comes of the step that goes on.
    fn ends_step(&self) -> bool {
        match self {
            Self::Stop => true,
            Self::Said(_, wish) => {
                matches!(wish, Wish::Pause | Wish::Reset | Wish::Load(_) | Wish::LoadText { .. })
            }
            Self::Compiled(compiled) => {
                compiled.scene.is_ok() && !matches!(compiled.purpose, Purpose::Set(_))
            }
            Self::Joined(_) | Self::Left(_) | Self::Asked(..) => false,
        }
    }
}

/// Where inputs are put.
#[derive(Clone)]
pub struct Inputs {
    sender: SyncSender<Input>,
    interruption: Interruption,
}

impl Inputs {
    /// Room for so many that wait; whoever puts more waits too.
    pub fn new(most: usize) -> (Self, Inbox) {
        let (sender, receiver) = sync_channel(most);
        let interruption = Interruption::default();
        (Self { sender, interruption: interruption.clone() }, Inbox { receiver, interruption })
    }

    /// What steps of the world heed.
    pub fn interruption(&self) -> &Interruption {
        &self.interruption
    }

    /// # Errors
    /// The world has ended.
    pub fn send(&self, input: Input) -> Result<(), SendError<Input>> {
        // no step goes on until it is taken; before it is there, as there may be no room for it while one goes on
        if input.ends_step() {
            self.interruption.wish();
        }
        self.sender.send(input)
    }
}

/// Where the world takes them.
pub struct Inbox {
    receiver: Receiver<Input>,
    interruption: Interruption,
}

impl Inbox {
    /// # Errors
    /// There is none, or nobody is left to put one.
    pub fn try_take(&self) -> Result<Input, TryRecvError> {
        self.receiver.try_recv().inspect(|input| self.taken(input))
    }

    /// Waits for one.
    ///
    /// # Errors
    /// None came in this time, or nobody is left to put one.
    pub fn take_within(&self, time: Duration) -> Result<Input, RecvTimeoutError> {
        self.receiver.recv_timeout(time).inspect(|input| self.taken(input))
    }

    fn taken(&self, input: &Input) {
        if input.ends_step() {
            self.interruption.withdraw();
        }
    }
}
