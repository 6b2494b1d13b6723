//! Lines on their way out, and what is aligned between them.

/// A line of a formatted text.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    /// How many blanks it begins with.
    pub(super) indent: usize,
    /// What it says.
    pub(super) text: String,
    /// A comment at its end.
    pub(super) comment: Option<String>,
    /// Whether an empty line stands before it.
    pub(super) blank_before: bool,
    /// Its parts, where it is aligned with lines of its kind.
    pub(super) cells: Option<Cells>,
}

/// `bound vx, vy in [-4, 4] m/s`, taken apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    /// `bound` or `disturbance`.
    pub(super) keyword: String,
    /// `vx, vy`
    pub(super) names: String,
    /// `[-4, 4]`
    pub(super) interval: String,
    /// `m/s`, or nothing.
    pub(super) unit: String,
}

/// All lines.
#[derive(Debug, Default)]
pub(super) struct Sheet {
    lines: Vec<Line>,
}

impl Sheet {
    /// Adds a line.
    pub(super) fn push(&mut self, line: Line) {
        self.lines.push(line);
    }

    /// Puts a comment at the end of the last line, if there is one without a comment.
    pub(super) fn trail(&mut self, comment: &str) -> bool {
        match self.lines.last_mut() {
            Some(line) if line.comment.is_none() && !line.text.is_empty() => {
                line.comment = Some(comment.to_owned());
                true
            }
            _ => false,
        }
    }

    /// Says what the last line is made of.
    pub(super) fn describe_last(&mut self, cells: Option<Cells>) {
        if let Some(line) = self.lines.last_mut() {
            line.cells = cells;
        }
    }

    /// The text, with what belongs under each other put there.
    pub(super) fn text(mut self) -> String {
        self.align_cells();
        let widths = self.comment_columns();
        let mut text = String::new();
        for (at, (line, column)) in self.lines.iter().zip(widths).enumerate() {
            if line.blank_before && at > 0 {
                text.push('\n');
            }
            let mut written = format!("{:indent$}{}", "", line.text, indent = line.indent);
            if let Some(comment) = &line.comment {
                let missing = column.saturating_sub(width(&written));
                written.push_str(&" ".repeat(missing + 2));
                written.push_str(comment);
            }
            text.push_str(written.trim_end());
            text.push('\n');
        }
        text
    }

    /// Runs of neighbours for which `joins` holds between each and the next, one at least.
    fn runs(&self, joins: impl Fn(&Line, &Line) -> bool) -> Vec<std::ops::Range<usize>> {
        let mut runs: Vec<std::ops::Range<usize>> = Vec::new();
        for (at, line) in self.lines.iter().enumerate() {
            match runs.last_mut() {
                Some(run) if !line.blank_before && joins(&self.lines[at - 1], line) => run.end = at + 1,
                _ => runs.push(at..at + 1),
            }
        }
        runs
    }

    /// Names, intervals and units of neighbours of one kind begin in the same columns.
    fn align_cells(&mut self) {
        let keyword = |line: &Line| line.cells.as_ref().map(|cells| cells.keyword.clone());
        for run in self.runs(|a, b| keyword(a).is_some() && keyword(a) == keyword(b)) {
            let cells: Vec<Cells> = self.lines[run.clone()].iter().filter_map(|l| l.cells.clone()).collect();
            let widest = |of: fn(&Cells) -> &String| cells.iter().map(|c| width(of(c))).max().unwrap_or(0);
            let (names, intervals) = (widest(|c| &c.names), widest(|c| &c.interval));
            for (line, cells) in self.lines[run].iter_mut().zip(&cells) {
                let Cells { keyword, names: own, interval, unit } = cells;
                line.text = format!("{keyword} {own:names$} in {interval:intervals$} {unit}");
                line.text.truncate(line.text.trim_end().len());
            }
        }
    }

    /// Where the comment of each line begins, less two: the same for neighbours with comments.
    fn comment_columns(&self) -> Vec<usize> {
        let mut columns = vec![0; self.lines.len()];
        for run in self.runs(|a, b| a.comment.is_some() && b.comment.is_some()) {
            let widest = self.lines[run.clone()].iter().map(|l| l.indent + width(&l.text)).max().unwrap_or(0);
            columns[run].fill(widest);
        }
        columns
    }
}

/// How many columns a text takes, as far as an editor counts characters.
pub(super) fn width(text: &str) -> usize {
    text.chars().count()
}
