//! Parts of a served page as text, for a program that shows it.

use clap::ValueEnum;

use crate::error::Error;
use crate::live::champion::champions;
use crate::live::page::{self, Chosen, Use};
use crate::live::serve::publisher::Served;
use crate::live::session::json;
use crate::run::plan::Plan;

/// A part of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PagePart {
    /// Page of the present champion.
    Page,
    /// Present champions as JSON, one of each population.
    Champions,
}

impl PagePart {
    /// Returns the text of the part.
    ///
    /// # Errors
    /// Errors of [`page::html`] and [`champions`].
    pub(crate) fn text(self, served: Served<'_, '_>, plan: &Plan<'_>) -> Result<String, Error> {
        let Served { laboratory, directory, module } = served;
        match self {
            Self::Page => {
                let used = Use::Served { run: &plan.name() };
                Ok(page::html(laboratory, (plan, directory), Chosen::default(), module(plan)?, used)?.html)
            }
            Self::Champions => json(&champions(plan, directory)?),
        }
    }
}
