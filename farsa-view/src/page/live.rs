//! A page whose trials are run by the page itself.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use crate::error::Error;
use crate::page::html::{composed, data_head};

/// A page that runs an agent by itself, by a module of WebAssembly that lies in it.
///
/// The module has the functions `input`, `open`, `answer` and `output` of the project's `farsa-live`; what the script and the
/// answers are is between it and the viewer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LivePage {
    /// What the page is called.
    pub title: String,
    /// Whether it looks from above.
    pub from_above: bool,
    /// The module, compressed by gzip.
    pub module: Vec<u8>,
    /// What the module opens: JSON.
    pub script: String,
    /// What the viewer is told of the agent: JSON.
    pub about: String,
}

impl LivePage {
    /// The whole file.
    ///
    /// # Errors
    /// [`Error::NotJson`] where the script or what is told of it is none.
    pub fn html(&self) -> Result<String, Error> {
        let parsed =
            |text: &str| serde_json::from_str::<Value>(text).map_err(|error| Error::NotJson(error.to_string()));
        let (script, about) = (parsed(&self.script)?, parsed(&self.about)?);
        let mut data = data_head(&self.title, self.from_above);
        data["lives"] = json!([]);
        data["live"] = json!({ "script": script, "about": about, "module": STANDARD.encode(&self.module) });
        Ok(composed(&self.title, &data, true))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::html::Page;

    #[test]
    fn a_live_page_may_run_its_module_and_a_film_may_not() {
        let page = LivePage {
            title: "a <b>".into(),
            from_above: true,
            module: vec![1, 2, 3],
            script: r#"{"config":"x = \"</script>\""}"#.into(),
            about: "[1]".into(),
        };
        let html = page.html().unwrap();
        assert!(html[..2000].contains(Page::MARK) && html.contains("wasm-unsafe-eval"));
        let (_, rest) = html.rsplit_once("id=\"data\">").unwrap();
        let (text, _) = rest.split_once("</script>").unwrap();
        let data: Value = serde_json::from_str(text).unwrap();
        assert_eq!(
            (&data["title"], &data["view"], &data["live"]["module"]),
            (&"a <b>".into(), &"top".into(), &"AQID".into())
        );
        assert_eq!(data["live"]["script"]["config"], "x = \"</script>\"");
        let film = Page::new("film").html();
        assert!(!film.contains("wasm-unsafe-eval") && !film.contains("DecompressionStream"));
        let wrong = LivePage { script: "{".into(), ..page };
        assert!(matches!(wrong.html(), Err(Error::NotJson(_))));
    }
}
