//! The reference experiments as WebAssembly, for the pages of `farsa live`.

use farsa_lab::Laboratory;
use farsa_lab::advanced::ExperimentFiles;

/// The built-in experiments and those of files. A page only reads files, so it needs no schema and no templates.
fn laboratory() -> Laboratory<'static> {
    let files = ExperimentFiles {
        schema: |_| Ok(String::new()),
        templates: &[],
        crate_with_parts: &[],
        ..farsa_compose::FILES
    };
    Laboratory::new(&farsa_experiments::all()).with_files(files)
}

farsa_lab::live_module!(laboratory);
