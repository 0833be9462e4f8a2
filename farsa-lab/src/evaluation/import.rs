//! `farsa import`: genotypes of the original FARSA as a directory that can be tested, replayed and drawn.

use std::path::{Path, PathBuf};

use farsa_evo::Fitness;
use serde::Serialize;

use crate::error::Error;
use crate::escaped::OneLine;
use crate::evaluation::genotypes::Shape;
use crate::evaluation::populations::Populations;
use crate::experiment::settings::Value;
use crate::run::plan::Plan;
use crate::run::records::{Best, Champions, write_imported};
use crate::store::directory::Directory;
use crate::store::manifest::Manifest;
use crate::store::replace::replace;
use crate::strategy::any_strategy::Genome;
use crate::strategy::settings::POPULATION;

/// Summary of an import.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    directory: String,
    experiment: String,
    condition: String,
    /// Number of genotypes per population.
    genotypes: usize,
    genes: usize,
    /// Names, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    populations: Vec<String>,
    files: Vec<String>,
}

impl Summary {
    /// Formats the same in a line of words.
    pub(crate) fn text(&self) -> String {
        let Self { genotypes, genes, populations, .. } = self;
        let (directory, files) = (OneLine(&self.directory), OneLine(self.files.join(", ")));
        if !populations.is_empty() {
            let names = populations.join(" and of ");
            return format!(
                "{directory}: {genotypes} of {names}, of {genes} genes each, from {files}; the first are the champions"
            );
        }
        let (what, champion) = match genotypes {
            1 => ("genotype", ""),
            _ => ("genotypes", "; individual 0 is the champion"),
        };
        format!("{directory}: {genotypes} {what} of {genes} genes from {files}{champion}")
    }
}

/// Makes a directory of the genotypes in some files: the individuals of generation 0, of which the first of each population
/// is the champion. `asked` is the size of a population that the settings were to have, if any.
///
/// # Errors
/// [`Error::Usage`] with the line for a file that is not a genotype file of this experiment, and for populations without
/// genotypes or with fewer than others. [`Error::File`] for an existing directory. Nothing is written on an error.
pub(crate) fn import(
    mut plan: Plan<'_>,
    paths: &[PathBuf],
    asked: Option<&Value>,
    out: &Path,
) -> Result<Summary, Error> {
    let evaluator = plan.evaluator()?;
    let (names, genotype) = (evaluator.info().populations, plan.genotype(evaluator.as_ref()));
    let of = genomes(paths, plan.experiment.name(), &names, Shape::from_genotype(&genotype))?;
    let (populations, size) = (names.len(), of.first().map_or(0, Vec::len));
    if populations > 1 {
        // So an individual's number gives its population.
        plan.settings.set("FILE", POPULATION, Value::Whole(i64::try_from(size).unwrap_or(i64::MAX)))?;
        if let Some(asked) = asked
            && *asked != *plan.settings.get(POPULATION)?
        {
            let why = format!("{size} genotypes of each population where --set wants {asked}");
            return Err(Error::setting(POPULATION, why));
        }
    }
    let first = |genomes: &Vec<Vec<u16>>| genomes.first().cloned();
    let best: Option<Vec<Vec<u16>>> = of.iter().map(first).collect();
    let Some(best) = best else {
        return Err(Error::Usage("no file to import".into()));
    };
    let files: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
    let summary = Summary {
        directory: out.display().to_string(),
        experiment: plan.experiment.name().into(),
        condition: plan.condition.clone(),
        genotypes: size,
        genes: genotype.genes(),
        populations: if populations > 1 { names } else { Vec::new() },
        files: files.clone(),
    };
    let (text, identity) = (plan.to_toml()?, plan.identity()?);
    Directory::create(out, |directory| {
        replace(&directory.config(), text.as_bytes())?;
        Manifest { imported: files, ..Manifest::new(&identity) }.write(&directory.manifest())?;
        // They have not been evaluated yet.
        let best = best.into_iter().enumerate().map(|(population, genes)| Best {
            individual: (population * size) as u32,
            fitness: Fitness::WORST,
            genes: Genome::Words(genes),
        });
        Champions { identity: identity.clone(), generation: 0, best: best.collect(), normalisation: None }
            .write(&directory.champion())?;
        let genomes = of.into_iter().flatten().collect();
        write_imported(&directory.genotypes(), identity, genomes, populations)
    })?;
    Ok(summary)
}

/// Gets the genotypes of each population, as many of each.
fn genomes(paths: &[PathBuf], experiment: &str, names: &[String], shape: Shape) -> Result<Vec<Vec<Vec<u16>>>, Error> {
    let populations = Populations { experiment, names };
    let given = paths.iter().map(|path| populations.file("FILE", path)).collect::<Result<_, _>>()?;
    let mut groups = Vec::new();
    for files in populations.divide("FILE", given)? {
        let mut genomes = Vec::new();
        for path in files {
            genomes.extend(shape.read(&path)?);
        }
        groups.push(genomes);
    }
    let sizes = || names.iter().zip(&groups).map(|(name, genomes)| format!("{} of {name}", genomes.len()));
    if groups.windows(2).any(|pair| pair[0].len() != pair[1].len()) {
        let sizes = sizes().collect::<Vec<_>>().join(" and ");
        return Err(Error::Usage(format!("{experiment}: {sizes}: as many genotypes of each population are wanted")));
    }
    Ok(groups)
}
