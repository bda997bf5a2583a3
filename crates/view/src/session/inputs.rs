//! The way in: what is sent to the world, and breaks off the step that goes on where it makes that pointless.

use std::sync::mpsc::{Receiver, SendError, SyncSender, sync_channel};

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
    /// Whether nobody wants any longer what comes of the step that goes on.
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
    pub fn new(most: usize) -> (Self, Receiver<Input>) {
        let (sender, receiver) = sync_channel(most);
        (Self { sender, interruption: Interruption::default() }, receiver)
    }

    /// What steps of the world heed.
    pub fn interruption(&self) -> &Interruption {
        &self.interruption
    }

    /// # Errors
    /// The world has ended.
    pub fn send(&self, input: Input) -> Result<(), SendError<Input>> {
        let ends_step = input.ends_step();
        if ends_step {
            // the world may have no room for more until its step has ended
            self.interruption.wish();
        }
        self.sender.send(input)?;
        if ends_step {
            // it may have begun another before this was there to be taken
            self.interruption.wish();
        }
        Ok(())
    }
}
