//! Robots of model files as lines of JSON, for `quality/models/run`: `describe_models ROOT [PACKAGES...] < FILES`.
//!
//! A file is first read strictly. If a mesh of a URDF or a mass is refused, it is read with more options. The refusals are
//! listed.

use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};

use farsa_models::{Imported, Meshes, ReadError, ReadOptions, Repair};
use serde_json::json;

/// Reads a file with as few options as possible.
fn imported(path: &Path, mut options: ReadOptions) -> (Vec<String>, Result<Imported, ReadError>) {
    let urdf = path.extension().is_some_and(|extension| extension == "urdf");
    let mut refusals = Vec::new();
    loop {
        let error = match Imported::from_file(path, &options) {
            Ok(model) => return (refusals, Ok(model)),
            Err(error) => error,
        };
        let mesh = matches!(error, ReadError::Path { .. } | ReadError::Mesh { .. } | ReadError::File { .. });
        let mass = matches!(error, ReadError::Mass { .. });
        if urdf && mesh && options.meshes == Meshes::Fit {
            options.meshes = Meshes::Leave;
        } else if mass && options.repair == Repair::default() {
            options.repair = Repair { least_mass: 1e-9, least_inertia: 1e-12, balance: true };
        } else {
            return (refusals, Err(error));
        }
        refusals.push(error.to_string());
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut folders = std::env::args_os().skip(1).map(PathBuf::from);
    let root = folders.next().ok_or("the folder of all models is missing")?;
    // Bodies with several joints keep their mass to the last digits.
    let options =
        ReadOptions { root: Some(root.clone()), packages: folders.collect(), between: 1e-9, ..ReadOptions::default() };
    let mut output = std::io::stdout().lock();
    for file in std::io::stdin().lock().lines() {
        let file = file?;
        let (refusals, result) = imported(&root.join(&file), options.clone());
        let line = match result {
            // No other program reports triangles.
            Ok(model) => {
                json!({ "file": file, "refusals": refusals, "model": Imported { meshes: Vec::new(), ..model } })
            }
            Err(error) => json!({ "file": file, "refusals": refusals, "error": error.to_string() }),
        };
        writeln!(output, "{line}")?;
    }
    Ok(())
}
