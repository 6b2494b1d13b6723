//! What `solve` is asked: a mission, or an instance file that carries one.

use super::Status;
use super::mission::Opening;
use super::output::plain_error;
use crate::back::smc::{self, Document};
use crate::diag::{Diagnostic, printable};
use crate::driver::{self, Encoding, Mission, Overrides, Reopened};
use crate::source::SourceFile;

/// A mission to be planned.
pub struct Asked {
    source: SourceFile,
    overrides: Overrides,
    /// What the search speaks of.
    pub encoding: Encoding,
    instance: Option<Instance>,
}

/// An instance file.
struct Instance {
    /// What messages call it by.
    name: String,
    document: Document,
    /// The lengths that the command line asks for instead.
    horizon: Option<(usize, usize)>,
}

impl Asked {
    /// Looks at what was given: a text that begins with `{` is an instance, since no mission does.
    ///
    /// # Errors
    /// The command's status when an instance can't be read, or the command line contradicts it; that
    /// was said.
    pub fn new(text: SourceFile, encoding: Option<Encoding>, opening: &Opening<'_>) -> Result<Asked, Status> {
        let overrides = opening.overrides;
        if !text.text.trim_start().starts_with('{') {
            let (overrides, encoding) = (overrides.clone(), encoding.unwrap_or_default());
            return Ok(Asked { source: text, overrides, encoding, instance: None });
        }
        let document = smc::read(&text.text).map_err(|e| opening.fail(malformed(&text, &e.to_string())))?;
        let own = driver::reopen(&document);
        if let Some(why) = contradiction(&own, overrides, encoding) {
            return Err(opening.fail(super::usage(why)));
        }
        let Reopened { source, overrides: of_file, encoding } = own;
        let instance = Some(Instance { name: text.name, document, horizon: overrides.horizon });
        Ok(Asked { source, overrides: of_file, encoding, instance })
    }

    /// Loads the mission; an instance must be its own.
    ///
    /// # Errors
    /// The command's status when there is something wrong, which was said.
    pub fn load(&self, opening: &Opening<'_>) -> Result<Mission, Status> {
        let mut mission = Opening { overrides: &self.overrides, ..*opening }.load(&self.source)?;
        if let Some(Instance { name, document, horizon }) = &self.instance {
            opening.overseer.enter("comparing the instance");
            if !driver::is_instance_of(document, &mission, &self.source) {
                return Err(opening.fail(altered(name)));
            }
            mission.problem.horizon = horizon.unwrap_or(mission.problem.horizon);
        }
        Ok(mission)
    }
}

/// What the command line asks for that an instance has not.
fn contradiction(own: &Reopened, asked: &Overrides, encoding: Option<Encoding>) -> Option<String> {
    if !asked.set.is_empty() {
        return Some("an instance has its parameters already: `--set` goes with the mission".into());
    }
    if encoding.is_some_and(|e| e != own.encoding) {
        return Some("an instance has its encoding already: `--encoding` goes with the mission".into());
    }
    if asked.float != own.overrides.float {
        return Some("an instance has its tubes already: `--float` goes with the mission".into());
    }
    let (from, to) = asked.horizon?;
    let has = match own.overrides.horizon {
        Some((first, last)) if first <= from && to <= last => return None,
        Some((first, last)) => format!("the lengths {first}..{last}"),
        None => "no length".into(),
    };
    Some(format!("`--horizon {from}..{to}` asks for more than the instance, which has {has}"))
}

fn malformed(text: &SourceFile, why: &str) -> Diagnostic {
    let name = printable(&text.name);
    plain_error("dosm::smc::malformed", format!("`{name}` is no instance: {}", printable(why)))
        .with_help("`dosmc compile MISSION -o DIR --emit smc` writes one")
}

fn altered(name: &str) -> Diagnostic {
    let name = printable(name);
    plain_error("dosm::smc::altered", format!("`{name}` is not the instance of the mission that it carries"))
        .with_help("it was changed, or written by another version of dosmc: compile the mission again")
}
