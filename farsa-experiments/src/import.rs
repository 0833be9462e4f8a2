//! `farsa import`: genotypes of the original FARSA as a directory that can be tested, replayed and drawn.

use farsa_evo::Fitness;
use serde::Serialize;

use crate::arguments_genotypes::ImportArgs;
use crate::directory::{Directory, replace};
use crate::error::Error;
use crate::evaluate;
use crate::experiment::Experiment;
use crate::genotypes::Shape;
use crate::manifest::Manifest;
use crate::records::{Ancestry, Best, Champions};
use crate::search::Descent;

/// What was imported.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    directory: String,
    experiment: String,
    condition: String,
    genotypes: usize,
    genes: usize,
    files: Vec<String>,
}

impl Summary {
    /// The same in a line of words.
    pub(crate) fn text(&self) -> String {
        let Self { directory, genotypes, genes, files, .. } = self;
        let (what, champion) = match genotypes {
            1 => ("genotype", ""),
            _ => ("genotypes", "; individual 0 is the champion"),
        };
        format!("{directory}: {genotypes} {what} of {genes} genes from {}{champion}", files.join(", "))
    }
}

/// Makes a directory of the genotypes in some files: the individuals of generation 0, of which the first is the champion.
///
/// # Errors
/// [`Error::Damaged`] with the line for a file that is none of the original's or of another experiment; nothing is then
/// written. [`Error::Occupied`] when there is something at the place already.
pub(crate) fn import(args: &ImportArgs, experiments: &[&dyn Experiment]) -> Result<Summary, Error> {
    let name = (args.experiment.as_str(), args.condition.as_deref());
    let mut plan = evaluate::plan(experiments, name, &args.set, args.ir_tables.as_deref())?;
    plan.seed = args.seed;
    let setup = plan.setup()?;
    evaluate::alone(&plan, setup.populations())?;
    let shape = Shape::of(setup.as_ref());
    let mut genomes = Vec::new();
    for path in &args.files {
        genomes.extend(shape.read(path)?);
    }
    let Some(genes) = genomes.first().cloned() else {
        return Err(Error::Usage("no file to import".into()));
    };
    let files: Vec<String> = args.files.iter().map(|path| path.display().to_string()).collect();
    let summary = Summary {
        directory: args.out.display().to_string(),
        experiment: plan.experiment.name().into(),
        condition: plan.condition.clone(),
        genotypes: genomes.len(),
        genes: genes.len(),
        files: files.clone(),
    };
    let (text, identity) = (plan.to_toml()?, plan.identity()?);
    Directory::create(&args.out, |directory| {
        replace(&directory.config(), text.as_bytes())?;
        Manifest { imported: files, ..Manifest::new(&identity) }.write(&directory.manifest())?;
        // Nobody has evaluated it yet.
        let best = vec![Best { individual: 0, fitness: Fitness::WORST, genes }];
        Champions { identity: identity.clone(), generation: 0, best }.write(&directory.champion())?;
        Ancestry { identity, descent: Descent::Imported(genomes) }.write(&directory.genotypes())
    })?;
    Ok(summary)
}
