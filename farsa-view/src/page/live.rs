//! A page whose trials are run by the page itself.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};

use crate::error::Error;
use crate::page::base91::base91;
use crate::page::html::{Kind, composed, data_head};

/// What begins a file that is compressed by xz.
const XZ: [u8; 6] = *b"\xfd7zXZ\0";
/// A module that reads such files, compressed by gzip: browsers do not. `farsa-live/build --unpacker` makes it.
const UNPACKER: &[u8] = include_bytes!("unpack.wasm.gz");

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
    /// Whether it is served by a program that tells what a run comes to: at `events`, by server-sent events.
    pub served: bool,
    /// The module, compressed by gzip or by xz.
    pub module: Vec<u8>,
    /// What the module opens: JSON.
    pub script: String,
    /// What the script is opened with as its `standing` where evolution goes on, if it can: JSON.
    pub standing: Option<String>,
    /// What the viewer is told of the agent: JSON.
    pub about: String,
}

impl LivePage {
    /// The whole file.
    ///
    /// # Errors
    /// [`Error::NotJson`] where the script, what is told of it or where evolution stands is none.
    pub fn html(&self) -> Result<String, Error> {
        let parsed =
            |text: &str| serde_json::from_str::<Value>(text).map_err(|error| Error::NotJson(error.to_string()));
        let (script, about) = (parsed(&self.script)?, parsed(&self.about)?);
        let standing = match &self.standing {
            Some(text) => parsed(text).map(|_| packed(&compressed(text.as_bytes())))?,
            None => Value::Null,
        };
        let mut data = data_head(&self.title, self.from_above);
        data["lives"] = json!([]);
        data["live"] = json!({
            "script": script,
            "about": about,
            "module": packed(&self.module),
            "unpacker": if self.module.starts_with(&XZ) { packed(UNPACKER) } else { Value::Null },
            "standing": standing,
            "served": self.served,
        });
        Ok(composed(&self.title, &data, if self.served { Kind::Served } else { Kind::Live }))
    }
}

/// Compressed bytes as they stand in a page: as text, with their number.
fn packed(compressed: &[u8]) -> Value {
    let by = if compressed.starts_with(&XZ) { "xz" } else { "gzip" };
    json!({ by: base91(compressed), "bytes": compressed.len() })
}

fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    // Writing into a vector cannot fail.
    encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default()
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
            served: false,
            module: vec![1, 2, 3],
            script: r#"{"config":"x = \"</script>\""}"#.into(),
            standing: None,
            about: "[1]".into(),
        };
        let html = page.html().unwrap();
        assert!(html[..2000].contains(Page::MARK) && html.contains("wasm-unsafe-eval"));
        let (_, rest) = html.rsplit_once("id=\"data\">").unwrap();
        let (text, _) = rest.split_once("</script>").unwrap();
        let data: Value = serde_json::from_str(text).unwrap();
        assert_eq!((&data["title"], &data["view"]), (&"a <b>".into(), &"top".into()));
        let live = &data["live"];
        assert_eq!(live["module"], json!({ "gzip": base91(&[1, 2, 3]), "bytes": 3 }));
        assert_eq!((&live["standing"], &live["unpacker"]), (&Value::Null, &Value::Null));
        assert_eq!(data["live"]["script"]["config"], "x = \"</script>\"");
        let film = Page::new("film").html();
        assert!(!film.contains("wasm-unsafe-eval") && !film.contains("DecompressionStream"));
        // Nothing but a served page may ask anybody for anything.
        let served = LivePage { served: true, ..page.clone() }.html().unwrap();
        assert!(served[..2000].contains("wasm-unsafe-eval") && served[..2000].contains("connect-src 'self'"));
        assert!(!html.contains("connect-src") && !film.contains("connect-src"));
        // What browsers cannot unpack comes with what can.
        let module = b"\xfd7zXZ\0\0".to_vec();
        let html = LivePage { module: module.clone(), ..page.clone() }.html().unwrap();
        let packed = json!({ "xz": base91(&module), "bytes": 7 }).to_string();
        assert!(html.contains(&packed[1..packed.len() - 1]) && html.contains(&base91(UNPACKER)));
        let wrong = LivePage { script: "{".into(), ..page };
        assert!(matches!(wrong.html(), Err(Error::NotJson(_))));
    }
}
