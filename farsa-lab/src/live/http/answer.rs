//! Body of an answer: a text in parts, or events.

use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use hyper::body::{Body, Bytes, Frame, SizeHint};
use serde::Serialize;

use crate::error::Error;
use crate::live::http::connections::Activity;
use crate::live::http::paced::{Events, Paced};
use crate::live::session::json;

/// Bytes of a part of a text. A client is slow if it does not read one in the time of a connection.
const PART: usize = 64 << 10;

/// Body whose progress is noted for the limits of its connection.
#[derive(Debug)]
pub(in crate::live) struct Answer {
    content: Content,
    activity: Arc<Activity>,
}

#[derive(Debug)]
enum Content {
    Text(Bytes),
    Events(Box<Paced>),
}

impl Answer {
    pub(in crate::live) fn text(text: Bytes, activity: Arc<Activity>) -> Self {
        activity.sends();
        Self { content: Content::Text(text), activity }
    }

    pub(in crate::live) fn events(events: impl Events, activity: Arc<Activity>) -> Self {
        activity.streams();
        Self { content: Content::Events(Box::new(Paced::new(events))), activity }
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

/// Formats an event of a stream. After a lost connection a browser sends the number of the last event.
///
/// # Errors
/// [`Error::Other`] for data that has no JSON.
pub(in crate::live) fn event(name: &str, number: Option<usize>, data: &impl Serialize) -> Result<Bytes, Error> {
    let number = number.map_or_else(String::new, |number| format!("id: {number}\n"));
    Ok(format!("event: {name}\n{number}data: {}\n\n", json(data)?).into())
}

/// Returns a page with the reason for which there is no other. It asks again after some seconds.
pub(in crate::live) fn absence(why: &str, seconds: u32) -> String {
    let page = maud::html! {
        (maud::DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="color-scheme" content="light dark";
                meta http-equiv="refresh" content=(seconds);
                title { "no page" }
            }
            body { p { (why) } }
        }
    };
    page.into_string()
}
