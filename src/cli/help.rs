//! What `--help` teaches below the flags: examples, exit statuses, and where to go next.
//!
//! A line without indentation that ends in a colon is a heading; the manual's pages make a section of
//! it. Every example works from the repository root, those of one text in their order
//! (`tests/help.rs` runs them all).

/// The whole command.
pub const DOSMC: &str = "\
A first plan:
  dosmc new relay                         # writes relay.dosm, explained line by line
  dosmc check relay.dosm                  # says what is wrong with it, and how to mend it
  dosmc solve relay.dosm -o out           # writes out/plan.json, its picture, and controllers
  dosmc verify out/plan.json relay.dosm   # checks the plan once more, believing nothing

Exit status:
  0  done; for `solve`, a plan was found and checked
  1  usage, or a file that can't be read or written
  2  the mission has errors
  3  no plan of any length in the horizon
  4  unknown: time, memory or numerics ran out first
  5  a plan does not check

Where to go next:
  `dosmc COMMAND --help` has examples of each command, `dosmc explain CODE` a page on each
  error, the directory examples/ a mission for each part of the language.";

/// `check`.
pub const CHECK: &str = "\
Everything is looked at that needs no search: the text, names and units, shapes, the tubes
that keep disturbances away, and each robot's start. As many errors as can be found are
reported in one run. Warnings do not change the exit status.

Examples:
  dosmc check examples/first.dosm
  dosmc check examples/paper/*.dosm
  dosmc check examples/paper/table1-4.dosm --set bases=2
  dosmc check --json - < examples/first.dosm

Exit status:
  0  no errors
  1  usage, or a mission can't be read
  2  a mission has errors

Where to go next:
  `dosmc explain CODE` says more about an error, with a mission that shows it and the mended
  one; `dosmc solve` plans a mission that has none.";

/// `solve`.
pub const SOLVE: &str = "\
The lengths of the mission's `horizon` are tried from the shortest up. DIR gets plan.json,
the plan with a witness for everything that it claims, plan.svg, its picture, and controller/,
a Rust crate for the robots: whole or not at all, and only for a plan that the exact checker
has accepted. Ctrl-C stops within a second and says what was reached.

Examples:
  dosmc solve examples/first.dosm -o out
  dosmc solve examples/paper/table1-4.dosm -o out --set bases=2
  dosmc solve examples/relay.dosm -o out --horizon 1..30 --timeout 1min
  dosmc solve examples/patrol.dosm -o out --json
  dosmc solve examples/first.dosm -o out --encoding paper -v
  dosmc solve examples/first.dosm -o out --float f32
  dosmc compile examples/first.dosm -o out --emit smc && dosmc solve out/first.smc.json -o out

Exit status:
  0  a plan was found and checked (--json: `shortest` if none is shorter)
  1  usage, or a file can't be read or written
  2  the mission has errors
  3  no plan of any length in the horizon, for the tubes and directions tried
  4  unknown: time, memory or numerics ran out first
  5  the plan found does not check

Where to go next:
  `dosmc verify out/plan.json MISSION` checks the plan again, on any machine. With no plan, try
  a longer --horizon, and the mission without its goals one after the other.";

/// `verify`.
pub const VERIFY: &str = "\
The checker knows the plan and the mission, and nothing of how the plan was found. It needs
no solver: every claim in the plan comes with its witness, and all arithmetic is exact.
Give the same --set as when the plan was made. That the mission's text has changed since is
only said (`same_text` with --json); the verdict comes from the checks alone.

Examples:
  dosmc solve examples/relay.dosm -o out
  dosmc verify out/plan.json examples/relay.dosm
  dosmc verify out/plan.json examples/relay.dosm --json

Exit status:
  0  the plan holds
  1  usage, or a file can't be read
  2  the mission has errors
  5  the plan does not check; the first failures are listed";

/// `simulate`.
pub const SIMULATE: &str = "\
The plan is checked first, as `verify` does it; give the same --set as when it was made. Then
every robot flies the very law that its controller has, disturbed as far as the mission says
it may be, or --exceed times as far. Each run is held against the mission itself: bounds,
true distances and links, regions, and the goals on what really happened. The least margin of
each kind is named with where and when it was. The same seed gives the same runs, with any
number of threads.

Examples:
  dosmc solve examples/relay.dosm -o out
  dosmc simulate out/plan.json examples/relay.dosm
  dosmc simulate out/plan.json examples/relay.dosm --runs 20 --disturbance aimed --csv runs.csv
  dosmc simulate out/plan.json examples/relay.dosm --exceed 1.3 --json
  dosmc render out/plan.json examples/relay.dosm -o runs.svg --runs 20 --seed 7

Exit status:
  0  simulated, and nothing was violated; with --exceed beyond 1, simulated
  1  usage, or a file can't be read or written
  2  the mission has errors
  4  unknown: stopped before all runs were made, and nothing was violated
  5  the plan does not check, or something was violated

Where to go next:
  docs/controller.md says what each figure means; `dosmc compile MISSION --plan out/plan.json
  --emit controller` writes the law as a crate.";

/// `render`.
pub const RENDER: &str = "\
The plan is checked first, as `verify` does it; give the same --set as when it was made.
The name of FILE says what is drawn: .svg is a picture for every browser; .html is a page
on which the robots move, in one file that needs no network; .png is a picture too, where
dosmc was built with `--features png`.

Examples:
  dosmc solve examples/relay.dosm -o out
  dosmc render out/plan.json examples/relay.dosm -o relay.svg
  dosmc render out/plan.json examples/relay.dosm -o relay.html
  dosmc render out/plan.json examples/relay.dosm -o cells.svg --encoding paper
  dosmc render out/plan.json examples/relay.dosm -o runs.svg --runs 20

Exit status:
  0  drawn
  1  usage, or a file can't be read or written
  2  the mission has errors
  5  the plan does not check";

/// `compile`.
pub const COMPILE: &str = "\
DIR gets a file for each format, for tools of your own. All are written whole, or none is.
Without --length, smc has all lengths of the horizon, cnf and smt2 the first of them.

Formats:
  ir    NAME.ir.json: the mission with exact numbers, names resolved, families written out
  smc   NAME.smc.json: the whole instance: clauses, convex rows, what literals stand for
  cnf   NAME.cnf: its Boolean part in DIMACS, for SAT solvers
  smt2  NAME.smt2: one length in SMT-LIB, for SMT solvers
  controller  with --plan: controller/, a Rust crate for the robots of a plan, which is checked
        first; with --float f32 only where the plan has room for its rounding

Examples:
  dosmc compile examples/relay.dosm -o out --emit ir
  dosmc compile examples/first.dosm -o out --emit smc,cnf,smt2 --length 6
  dosmc compile examples/first.dosm -o out --emit smc --horizon 1..8
  dosmc solve examples/first.dosm -o out
  dosmc compile examples/first.dosm --plan out/plan.json -o out --emit controller

Exit status:
  0  written
  1  usage, or a file can't be read or written
  2  the mission has errors
  4  unknown: time ran out first
  5  the plan does not check, or leaves no room for the controller's rounding

Where to go next:
  docs/schemas describes the JSON files; `dosmc solve NAME.smc.json` plans from an instance.";

/// `lsp`.
pub const LSP: &str = "\
Editors start this by themselves; docs/editors says how to set each up. `--set` and
`--horizon` hold for all missions of the session. The command `dosmc.solve` plans a mission
and writes what `dosmc solve` writes, and plan.html, into out/NAME beside it.

Examples:
  dosmc lsp < /dev/null

Exit status:
  0  the session ended as the protocol asks, or never began
  1  the client went away, or ended the session without `shutdown`";

/// `fmt`.
pub const FMT: &str = "\
One declaration and one item a line, blanks where they help, tables in columns, neighbours'
intervals, units and comments under each other. Comments stay where they belong, and so do
single empty lines and line breaks inside formulas. A declaration with errors is left as it
is written. Nothing else than blanks, line ends and semicolons between items ever changes.

Examples:
  dosmc fmt --check examples/first.dosm
  dosmc fmt - < examples/first.dosm
  dosmc new scout && dosmc fmt scout.dosm

Exit status:
  0  done; with --check, everything is in the style
  1  usage, a file can't be read or written, or with --check a mission is not in the style
  2  a mission can't be read at all";

/// `new`.
pub const NEW: &str = "\
The mission is small and complete: a scout has to visit a place again and again, around a
jammer, and a second robot relays for it. Every line is explained. A file that is there
already is left alone.

Examples:
  dosmc new patrol && dosmc solve patrol.dosm -o out

Exit status:
  0  written
  1  usage, not a name, or the file is there already

Where to go next:
  examples/first.dosm is smaller still; the others in examples/ each show one part of the
  language.";

/// `explain`.
pub const EXPLAIN: &str = "\
A page has the meaning in plain words, what would go wrong otherwise, a mission that shows
the error, and the mended mission. The code may be shortened to `check::duplicate`, or to
`duplicate` where no other phase has that name. A phase alone, such as `tube`, lists its
codes; without a code all are listed.

Examples:
  dosmc explain dosm::check::unknown_region
  dosmc explain weak_inputs
  dosmc explain tube
  dosmc explain | grep unit
  dosmc explain --json duplicate

Exit status:
  0  explained
  1  no such code; the nearest ones are named";

/// `completions`.
pub const COMPLETIONS: &str = "\
Put the script where your shell looks for it, or read it in when the shell starts.

Examples:
  dosmc completions bash > dosmc.bash   # read it in with `source dosmc.bash`
  dosmc completions zsh > _dosmc        # belongs into a directory of $fpath
  dosmc completions fish > dosmc.fish   # belongs into ~/.config/fish/completions

Exit status:
  0  printed
  1  usage";

/// `man`.
pub const MAN: &str = "\
Without -o the page of `dosmc` itself is printed; with it DIR gets dosmc.1 and a page for
each command, such as dosmc-solve.1.

Examples:
  dosmc man | man -l -
  dosmc man -o man/man1 && man -M man dosmc-solve

Exit status:
  0  printed or written
  1  usage, or a file can't be written";
