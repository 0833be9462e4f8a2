//! Body of an answer: a text in parts, or events.

use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use hyper::body::{Body, Bytes, Frame, SizeHint};

use crate::live::serve::connections::Activity;
use crate::live::serve::events::Events;

/// Bytes of a part of a text. A client is slow if it does not read one in the time of a connection.
const PART: usize = 64 << 10;

/// Body whose progress is noted for the limits of its connection.
#[derive(Debug)]
pub(super) struct Answer {
    content: Content,
    activity: Arc<Activity>,
}

#[derive(Debug)]
enum Content {
    Text(Bytes),
    Events(Box<Events>),
}

impl Answer {
    pub(super) fn text(text: Bytes, activity: Arc<Activity>) -> Self {
        activity.sends();
        Self { content: Content::Text(text), activity }
    }

    pub(super) fn events(events: Events, activity: Arc<Activity>) -> Self {
        activity.streams();
        Self { content: Content::Events(Box::new(events)), activity }
    }
}

impl Body for Answer {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        self.activity.touch();
        let part = match &mut self.content {
            Content::Text(text) if text.is_empty() => Poll::Ready(None),
            // Parts share the memory of the text.
            Content::Text(text) => Poll::Ready(Some(text.split_to(text.len().min(PART)))),
            Content::Events(events) => events.poll(context),
        };
        part.map(|part| part.map(|bytes| Ok(Frame::data(bytes))))
    }

    fn is_end_stream(&self) -> bool {
        matches!(&self.content, Content::Text(text) if text.is_empty())
    }

    fn size_hint(&self) -> SizeHint {
        match &self.content {
            Content::Text(text) => SizeHint::with_exact(text.len() as u64),
            Content::Events(_) => SizeHint::default(),
        }
    }
}
