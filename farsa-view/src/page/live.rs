//! A page whose episodes are run by the page itself.

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};

use crate::error::Error;
use crate::page::html::{Kind, composed, data_head};

/// An interactive page that runs an agent in the browser. It uses a WebAssembly module that is stored in the page.
///
/// This module must export the functions `input`, `open`, `answer` and `output`, as `farsa-live` of the project
/// does. Runs and requests are JSON. Only the module and the viewer need to understand them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LivePage {
    /// Title of the page.
    pub title: String,
    /// If this is `true`, the camera looks from above.
    pub from_above: bool,
    /// Set this to `true` if a program serves the page. It must report the progress of a run at `events`, using
    /// server-sent events.
    pub served: bool,
    /// WebAssembly module, compressed with gzip.
    pub module: Vec<u8>,
    /// Run that the module opens, as JSON.
    pub script: String,
    /// State from which evolution continues, as JSON. Use `None` if it cannot be continued.
    pub state: Option<String>,
    /// Description of the agent for the viewer, as JSON.
    pub about: String,
}

impl LivePage {
    /// Writes the complete page as HTML.
    ///
    /// # Errors
    /// Returns [`Error::NotJson`] if the run, its description or its state is not valid JSON.
    pub fn html(&self) -> Result<String, Error> {
        let parsed =
            |text: &str| serde_json::from_str::<Value>(text).map_err(|error| Error::NotJson(error.to_string()));
        let (script, about) = (parsed(&self.script)?, parsed(&self.about)?);
        let state = match &self.state {
            Some(text) => parsed(text).map(|_| encoded(&compressed(text.as_bytes())))?,
            None => Value::Null,
        };
        let mut data = data_head(&self.title, self.from_above);
        data["episodes"] = json!([]);
        data["live"] = json!({
            "script": script,
            "about": about,
            "module": encoded(&self.module),
            "standing": state,
            "served": self.served,
        });
        Ok(composed(&self.title, &data, if self.served { Kind::Served } else { Kind::Live }))
    }
}

fn encoded(compressed: &[u8]) -> Value {
    STANDARD.encode(compressed).into()
}

fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    // Writing to a vector cannot fail.
    encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::html::Page;

    #[test]
    fn only_live_pages_may_run_a_module() {
        let page = LivePage {
            title: "a <b>".into(),
            from_above: true,
            served: false,
            module: vec![1, 2, 3],
            script: r#"{"config":"x = \"</script>\""}"#.into(),
            state: None,
            about: "[1]".into(),
        };
        let html = page.html().unwrap();
        assert!(html.contains("wasm-unsafe-eval"));
        let (_, rest) = html.rsplit_once("id=\"data\">").unwrap();
        let (text, _) = rest.split_once("</script>").unwrap();
        let data: Value = serde_json::from_str(text).unwrap();
        assert_eq!((&data["title"], &data["view"]), (&"a <b>".into(), &"top".into()));
        let live = &data["live"];
        assert_eq!((&live["module"], &live["standing"]), (&"AQID".into(), &Value::Null));
        assert_eq!(data["live"]["script"]["config"], "x = \"</script>\"");
        let recorded = Page::new("recorded").html();
        assert!(!recorded.contains("wasm-unsafe-eval") && !recorded.contains("DecompressionStream"));
        // Only a served page may open connections.
        let served = LivePage { served: true, ..page.clone() }.html().unwrap();
        assert!(served[..2000].contains("wasm-unsafe-eval") && served[..2000].contains("connect-src 'self'"));
        assert!(!html.contains("connect-src") && !recorded.contains("connect-src"));
        let wrong = LivePage { script: "{".into(), ..page };
        assert!(matches!(wrong.html(), Err(Error::NotJson(_))));
    }
}
