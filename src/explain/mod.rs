//! One page for each diagnostic code: what it means, why it matters, a mission that shows it and the
//! mended one.
//!
//! The pages are `docs/codes/PHASE/NAME.md`, compiled in. `tests/explain.rs` holds them to what they
//! say: every code has a page, every mission shown does what its page claims.

mod draw;

pub use draw::draw;

/// What there is to say about a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Page {
    /// The diagnostic's code, `dosm::<phase>::<name>`.
    pub code: &'static str,
    /// The page, in Markdown; its first line is `` # `CODE`: HEADLINE ``.
    pub text: &'static str,
}

impl Page {
    /// What the code says, in a few words.
    pub fn headline(&self) -> &'static str {
        let title = self.text.lines().next().unwrap_or_default();
        title.split_once("`: ").map_or(title, |(_, headline)| headline)
    }

    /// The code's second part: who says it.
    fn phase(&self) -> &'static str {
        self.code.split("::").nth(1).unwrap_or_default()
    }

    /// The code's last part.
    fn name(&self) -> &'static str {
        self.code.rsplit("::").next().unwrap_or(self.code)
    }
}

/// The pages of some codes, one line a phase; a name without a file does not compile.
macro_rules! pages {
    ($($phase:ident: $($name:ident)*;)*) => {
        &[$($(Page {
            code: concat!("dosm::", stringify!($phase), "::", stringify!($name)),
            text: include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"), "/docs/codes/", stringify!($phase), "/", stringify!($name), ".md"
            )),
        },)*)*]
    };
}

/// All pages, sorted by their codes.
pub const PAGES: &[Page] = pages! {
    abstraction:
        region_too_small start_in_jammer start_in_obstacle start_outside_bound start_outside_workspace
        starts_too_close;
    check:
        bad_every bad_hops bad_horizon bad_order bad_redundancy bad_rejection bad_window bad_workspace
        base_in_blocker base_outside blocker_outside box_corners_swapped circle count_of_another
        different_steps division_by_zero duplicate duplicate_point empty_interval empty_shape
        false_goal family_as_member family_too_large flat_shape formula_too_large hidden_name
        incoherent_unit index_out_of_table integrator_clash misplaced_doc misplaced_table
        misplaced_uncertainty missing_base missing_bound missing_item missing_robot missing_step
        missing_workspace mixed_window negative_uncertainty no_coordinate no_such_member not_a_table
        not_convex not_linear not_positive not_whole number_out_of_range open_inequality outside_domain
        predeclared ragged_table region_outside set_value stiff_model table_as_number too_many_parts
        trivial_goal unbounded_shape unit_twice unknown_constant unknown_dynamics unknown_formula
        unknown_function unknown_norm unknown_objective unknown_param unknown_region unknown_robot
        unknown_signal unknown_unit unsupported unused window_between_steps wrong_argument_count
        wrong_dimension wrong_index_count wrong_kind wrong_matrix_size wrong_point wrong_position;
    cli:
        bad_name too_large unknown_code unreadable unwritable usage;
    controller:
        rounding;
    ir:
        invalid;
    plan:
        malformed;
    smc:
        altered malformed;
    syntax:
        chained_comparison double_equals empty expected foreign_letter hidden_character long_name
        lookalike misplaced_unit missing_comma missing_edition not_utf8 number_form number_range
        number_too_long reserved_word sum_bracket text_too_long too_deep too_many_errors too_nested
        unclosed_bracket unclosed_comment unit_exponent unit_in_exponent unit_twice unit_with_blanks
        unknown_character unknown_edition unopened_bracket window_on_next;
    tube:
        badly_conditioned narrow_bounds unbounded uncontrollable weak_inputs wider_than_bound
        wider_than_workspace;
};

/// What came of looking a code up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// Its page.
    Page(&'static Page),
    /// The pages of a phase that has this name.
    Phase(Vec<&'static Page>),
    /// Pages of several phases that have this name.
    Several(Vec<&'static Page>),
    /// There is none; the pages whose codes look most like it, the likeliest first.
    None(Vec<&'static Page>),
}

/// The page of a code: `dosm::check::duplicate`, `check::duplicate`, or `duplicate` where no other
/// phase has that name; or all pages of a phase, `tube`. Upper and lower case are the same.
pub fn find(query: &str) -> Found {
    let query = query.trim().to_ascii_lowercase();
    let short = query.strip_prefix("dosm::").unwrap_or(&query);
    let fits = |page: &&Page| page.code["dosm::".len()..] == *short || page.name() == short;
    let phase: Vec<&Page> = PAGES.iter().filter(|page| page.phase() == short).collect();
    match PAGES.iter().filter(fits).collect::<Vec<_>>().as_slice() {
        [] if !phase.is_empty() => Found::Phase(phase),
        [] => Found::None(nearest(short)),
        [page] => Found::Page(page),
        several => Found::Several(several.to_vec()),
    }
}

/// How many similar codes are named, and how similar they have to be, from 0 to 1.
const MOST_NEAR: usize = 4;
const LEAST_LIKENESS: f64 = 0.75;

/// The pages that the words may have been meant for: those of codes spelt alike, and those whose
/// headline has the word in it.
fn nearest(short: &str) -> Vec<&'static Page> {
    let like = |page: &Page| {
        let whole = strsim::jaro_winkler(&page.code["dosm::".len()..], short);
        let said = short.len() > 2 && (page.name().contains(short) || page.headline().contains(short));
        let word = if said { 0.9 } else { 0.0 };
        whole.max(strsim::jaro_winkler(page.name(), short)).max(word)
    };
    let mut near: Vec<(f64, &Page)> = PAGES.iter().map(|page| (like(page), page)).collect();
    near.retain(|(likeness, _)| *likeness >= LEAST_LIKENESS);
    near.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    near.into_iter().take(MOST_NEAR).map(|(_, page)| page).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_may_be_shortened() {
        let code = |query: &str| match find(query) {
            Found::Page(page) => page.code,
            other => panic!("{query}: {other:?}"),
        };
        for query in ["dosm::check::duplicate", "check::duplicate", "duplicate", " Check::DUPLICATE "] {
            assert_eq!(code(query), "dosm::check::duplicate");
        }
        assert_eq!(code("syntax::unit_twice"), "dosm::syntax::unit_twice");
    }

    #[test]
    fn a_name_of_two_phases_is_not_guessed() {
        let Found::Several(pages) = find("unit_twice") else { panic!("two phases have it") };
        let codes: Vec<&str> = pages.iter().map(|p| p.code).collect();
        assert_eq!(codes, ["dosm::check::unit_twice", "dosm::syntax::unit_twice"]);
    }

    #[test]
    fn a_phase_has_all_its_pages() {
        for query in ["tube", "dosm::tube"] {
            let Found::Phase(pages) = find(query) else { panic!("it is a phase") };
            assert!(pages.len() > 5 && pages.iter().all(|page| page.code.starts_with("dosm::tube::")));
        }
    }

    #[test]
    fn a_word_of_a_headline_is_enough_for_a_suggestion() {
        let Found::None(near) = find("jammer") else { panic!("it is no code") };
        assert!(near.iter().any(|page| page.code == "dosm::check::blocker_outside"), "{near:?}");
    }

    #[test]
    fn the_likeliest_code_comes_first() {
        for (query, code) in [
            ("duplicat", "dosm::check::duplicate"),
            ("dosm::check::unknown_regoin", "dosm::check::unknown_region"),
            ("dosm::cheque::unknown_region", "dosm::check::unknown_region"),
            ("WEAK_INPUT", "dosm::tube::weak_inputs"),
        ] {
            let Found::None(near) = find(query) else { panic!("{query} is no code") };
            assert_eq!(near.first().map(|p| p.code), Some(code), "{query}");
        }
        assert_eq!(find("xyzzy"), Found::None(Vec::new()));
        assert_eq!(find(""), Found::None(Vec::new()));
        assert_eq!(find("::"), Found::None(Vec::new()));
    }
}
