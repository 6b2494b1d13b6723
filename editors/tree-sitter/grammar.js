/**
 * The grammar of dosm missions, edition 1, for editors.
 *
 * It follows grammar/dosm.pest rule by rule. Three things need to look ahead and are read by
 * src/scanner.c: reserved words (never a name, wherever they stand), units (`2 m*s`, but `2 m*speed`)
 * and comments that nest. All other words are words only in their place.
 */

/// <reference types="tree-sitter-cli/dsl" />

// Generated: words(declarations, prepositions, logic, truths, temporal, quantifiers, sets, temporal_letters)
const RESERVED = ["dosm", "mission", "param", "let", "workspace", "region", "obstacle", "opaque",
  "jammer", "base", "dynamics", "robot", "team", "separation", "connectivity", "horizon", "minimize",
  "goal", "define", "in", "at", "and", "or", "not", "true", "false", "always", "eventually", "next",
  "until", "release", "weak", "strong", "forall", "exists", "count", "all", "X", "F", "G", "U", "R",
  "W", "M"];

/** How tight operators bind; a quantifier reaches as far right as possible. */
const LEVEL = {
  quantifier: 0,
  iff: 1,
  implies: 2,
  or: 3,
  and: 4,
  until: 5,
  prefix: 6,

  sum: 1,
  product: 2,
  negation: 3,
  power: 4,
};

const list = (rule) => seq(rule, repeat(seq(",", rule)));

module.exports = grammar({
  name: "dosm",

  word: ($) => $.identifier,

  // The order is that of src/scanner.c.
  externals: ($) => [$.block_comment, $.unit, $._unit_one, $._error, ...RESERVED],

  extras: ($) => [/[ \t\r\n]/, $.line_comment, $.doc_comment, $.block_comment],

  // `(R1 in depot)` is a formula or a term of a sum; what follows it decides.
  conflicts: ($) => [[$._formula, $.counted]],

  rules: {
    source_file: ($) => repeat($._declaration),

    // ---- Declarations -------------------------------------------------------------------------

    _declaration: ($) =>
      choice(
        $.edition_declaration,
        $.mission_declaration,
        $.param_declaration,
        $.let_declaration,
        $.workspace_declaration,
        $.region_declaration,
        $.obstacle_declaration,
        $.jammer_declaration,
        $.base_declaration,
        $.dynamics_declaration,
        $.robot_declaration,
        $.team_declaration,
        $.separation_declaration,
        $.connectivity_declaration,
        $.horizon_declaration,
        $.minimize_declaration,
        $.goal_declaration,
        $.define_declaration,
      ),

    edition_declaration: ($) => seq("dosm", field("edition", $.number)),

    mission_declaration: ($) => seq("mission", field("name", $.identifier)),

    param_declaration: ($) =>
      seq("param", field("name", $.identifier), "=", field("value", $._expression)),

    let_declaration: ($) =>
      seq("let", field("name", $.identifier), "=", field("value", $._value)),

    workspace_declaration: ($) => seq("workspace", field("shape", $._shape)),

    region_declaration: ($) => seq("region", $._family, "=", field("shape", $._shape)),

    obstacle_declaration: ($) =>
      seq(optional("opaque"), "obstacle", $._family, "=", field("shape", $._shape)),

    jammer_declaration: ($) => seq("jammer", $._family, "=", field("shape", $._shape)),

    base_declaration: ($) => seq("base", $._family, "at", field("place", $.point)),

    dynamics_declaration: ($) =>
      seq("dynamics", field("name", $.identifier), field("body", $.dynamics_block)),

    robot_declaration: ($) =>
      seq(
        "robot",
        $._family,
        ":",
        field("dynamics", $.identifier),
        "at",
        field("start", choice($.point, $.full_state)),
      ),

    team_declaration: ($) =>
      seq("team", field("name", $.identifier), "=", field("members", $.set)),

    separation_declaration: ($) => seq("separation", field("length", $._expression)),

    connectivity_declaration: ($) =>
      seq("connectivity", choice("none", field("body", $.connectivity_block))),

    horizon_declaration: ($) => seq("horizon", field("lengths", $.range)),

    minimize_declaration: ($) => seq("minimize", field("objective", $.identifier)),

    goal_declaration: ($) =>
      seq("goal", field("name", $.identifier), ":", field("formula", $._formula)),

    define_declaration: ($) =>
      seq("define", field("name", $.identifier), "=", field("formula", $._formula)),

    // ---- Names --------------------------------------------------------------------------------

    identifier: (_) => /[A-Za-z_][A-Za-z0-9_]*/,

    // A declared name, with indices where it declares a family: `J[i in 1..3, j in 1..2]`.
    _family: ($) => seq(field("name", $.identifier), optional(field("indices", $.indices))),
    indices: ($) => seq("[", list($.index_range), "]"),
    index_range: ($) => seq(field("name", $.identifier), "in", field("range", $.range)),
    range: ($) => seq(field("from", $._expression), "..", field("to", $._expression)),

    // A used name, with indices where it names a member or an entry: `J[i, 2]`.
    reference: ($) => seq(field("name", $.identifier), optional(field("index", $.index))),
    index: ($) => seq("[", list($._expression), "]"),

    set: ($) => list(choice("all", $.reference)),

    // ---- Expressions --------------------------------------------------------------------------

    _expression: ($) =>
      choice(
        $.number,
        $.quantity,
        $.parenthesized_expression,
        $.call,
        $.reference,
        $.unary_expression,
        $.binary_expression,
      ),

    quantity: ($) => seq($.number, $.unit),

    parenthesized_expression: ($) => seq("(", $._expression, ")", optional($.unit)),

    call: ($) =>
      seq(field("function", $.identifier), field("arguments", $.arguments), optional($.unit)),
    arguments: ($) => seq("(", list($._expression), ")"),

    unary_expression: ($) => prec(LEVEL.negation, seq("-", $._expression)),

    binary_expression: ($) => {
      const binary = (operator) =>
        seq(field("left", $._expression), field("operator", operator), field("right", $._expression));
      return choice(
        prec.left(LEVEL.sum, binary(choice("+", "-"))),
        prec.left(LEVEL.product, binary(choice("*", "/"))),
        prec.right(LEVEL.power, binary("^")),
      );
    },

    number: (_) => /[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?/,

    _value: ($) => choice($.table, $._expression),
    table: ($) => seq("[", $.row, repeat(seq(";", $.row)), "]", optional($.unit)),
    row: ($) => list($._expression),

    // ---- Shapes -------------------------------------------------------------------------------

    _shape: ($) => choice($.union, $._piece),
    union: ($) => seq($._piece, repeat1(seq("or", $._piece))),
    _piece: ($) => choice($.box, $.ball, $.disc, $.polygon, $.hull, $.half_spaces),

    box: ($) => seq("box", field("from", $.point), "..", field("to", $.point)),
    ball: ($) => seq("ball", field("center", $.point), $._radius, optional($._norm)),
    disc: ($) => seq("disc", field("center", $.point), $._radius),
    polygon: ($) => seq("polygon", list($.point)),
    hull: ($) => seq("hull", list($.point)),
    half_spaces: ($) => seq("where", $.inequalities),

    _radius: ($) => seq("radius", field("radius", $._coordinate)),
    _norm: ($) => seq("norm", field("norm", $.number)),

    point: ($) => seq("(", list($._coordinate), ")", optional($.unit)),
    _coordinate: ($) => choice($._expression, $.uncertain),
    uncertain: ($) => seq($._expression, choice("+/-", "±"), $._expression),

    inequalities: ($) => seq("{", $.inequality, repeat(seq(";", $.inequality)), optional(";"), "}"),
    inequality: ($) =>
      seq(
        field("left", $._expression),
        field("operator", $._comparator),
        field("right", $._expression),
      ),
    _comparator: (_) => choice("!=", "<=", ">=", "<", ">", "="),

    // ---- Motion models and robots ---------------------------------------------------------------

    dynamics_block: ($) => seq("{", repeat(seq($._dynamics_item, optional(";"))), "}"),

    _dynamics_item: ($) =>
      choice(
        $.step_item,
        $.state_item,
        $.input_item,
        $.position_item,
        $.continuous_item,
        $.integrator_item,
        $.bound_item,
        $.disturbance_item,
        $.rejection_item,
        $.mode_item,
        $.matrix_item,
      ),

    step_item: ($) => seq("step", field("time", $._expression)),
    state_item: ($) => seq("state", list($.signal)),
    input_item: ($) => seq("input", list($.signal)),
    signal: ($) =>
      seq(
        field("name", $.identifier),
        ":",
        field("unit", choice($.unit, alias($._unit_one, $.unit))),
      ),
    position_item: ($) => seq("position", field("names", $.names)),
    continuous_item: (_) => "continuous",
    integrator_item: ($) => seq("integrator", field("order", $._expression)),
    bound_item: ($) =>
      seq(
        "bound",
        choice(
          seq("where", $.inequalities),
          seq(field("names", choice($.names, alias($._names_where, $.names))), "in", $.interval),
        ),
      ),
    disturbance_item: ($) => seq("disturbance", field("names", $.names), "in", $.interval),
    rejection_item: ($) => seq("rejection", field("share", $._expression)),
    mode_item: ($) =>
      seq(
        "mode",
        field("name", $.identifier),
        "when",
        field("condition", $.inequalities),
        field("body", $.mode_block),
      ),
    mode_block: ($) => seq("{", repeat(seq($.matrix_item, optional(";"))), "}"),
    matrix_item: ($) =>
      seq(field("name", choice("A", "B", "c")), "=", field("value", $._value)),

    names: ($) => list($.identifier),
    // A state may be called `where`.
    _names_where: ($) => seq(alias("where", $.identifier), repeat(seq(",", $.identifier))),
    interval: ($) =>
      seq(
        "[",
        field("from", $._expression),
        ",",
        field("to", $._expression),
        "]",
        optional($.unit),
      ),

    full_state: ($) => seq("{", optional(seq(list($.entry), optional(","))), "}"),
    entry: ($) => seq(field("name", $.identifier), "=", field("value", $._expression)),

    // ---- Connectivity ---------------------------------------------------------------------------

    connectivity_block: ($) => seq("{", repeat(seq($._connectivity_item, optional(";"))), "}"),
    _connectivity_item: ($) =>
      choice($.hops_item, $.range_item, $.redundancy_item, $.every_item),
    hops_item: ($) => seq("hops", "<=", field("most", $._expression)),
    range_item: ($) => seq("range", field("length", $._expression), optional($._norm)),
    redundancy_item: ($) => seq("redundancy", field("lost", $._expression)),
    every_item: ($) => seq("every", field("period", $._expression)),

    // ---- Formulas -------------------------------------------------------------------------------

    _formula: ($) =>
      choice(
        $.truth,
        $.membership,
        $.comparison,
        $.defined,
        $.parenthesized_formula,
        $.unary_formula,
        $.binary_formula,
        $.quantified_formula,
      ),

    truth: (_) => choice("true", "false"),
    membership: ($) => seq(field("robot", $.reference), "in", field("region", $.reference)),
    defined: ($) => field("name", $.identifier),
    parenthesized_formula: ($) => seq("(", $._formula, ")"),

    unary_formula: ($) => {
      const unary = (operator) => seq(operator, field("operand", $._formula));
      const operator = (...signs) => field("operator", choice(...signs));
      return prec(
        LEVEL.prefix,
        choice(
          unary(operator("not", "!")),
          unary(operator("next", "X")),
          unary(seq(operator("always", "G", "[]"), optional($._window))),
          unary(seq(operator("eventually", "F", "<>"), optional($._window))),
        ),
      );
    },

    binary_formula: ($) => {
      const binary = (operator) =>
        seq(field("left", $._formula), operator, field("right", $._formula));
      const operator = (...signs) => field("operator", signs.length > 1 ? choice(...signs) : signs[0]);
      const until = choice(
        operator("until", "U"),
        operator("release", "R"),
        operator("W", $.weak_until),
        operator("M", $.strong_release),
      );
      return choice(
        prec.left(LEVEL.iff, binary(operator("<->"))),
        prec.right(LEVEL.implies, binary(operator("->"))),
        prec.left(LEVEL.or, binary(operator("or", "||"))),
        prec.left(LEVEL.and, binary(operator("and", "&&"))),
        prec.right(LEVEL.until, binary(seq(until, optional($._window)))),
      );
    },

    weak_until: (_) => seq("weak", "until"),
    strong_release: (_) => seq("strong", "release"),

    quantified_formula: ($) =>
      prec(
        LEVEL.quantifier,
        seq(
          field("quantifier", choice("forall", "exists")),
          field("variable", $.identifier),
          "in",
          field("over", choice($.range, $.set)),
          ":",
          field("body", $._formula),
        ),
      ),

    _window: ($) => field("window", $.window),
    window: ($) =>
      seq("[", field("from", $._expression), ",", field("to", $._expression), "]"),

    // Sums have no brackets of their own: `(R1 in A) + 2 * count(r in all: r in B) - 1`.
    comparison: ($) =>
      seq(field("left", $._sum), field("operator", $._comparator), field("right", $._sum)),
    _sum: ($) => choice($.sum, $._term),
    sum: ($) => seq($._term, repeat1(seq(choice("+", "-"), $._term))),
    _term: ($) => choice($.negative_term, $._product),
    negative_term: ($) => seq("-", $._product),
    _product: ($) => choice($._factors, $._atom, $.product),
    product: ($) => seq($._factors, "*", $._atom),
    _factors: ($) => choice($.number, $.reference, alias($._constant_product, $.product)),
    _constant_product: ($) => seq($._factors, "*", choice($.number, $.reference)),
    _atom: ($) => choice($.count, $.counted),
    count: ($) =>
      seq(
        "count",
        "(",
        field("variable", $.identifier),
        "in",
        field("set", $.set),
        ":",
        field("atom", $.membership),
        ")",
      ),
    counted: ($) => seq("(", $.membership, ")"),

    // ---- Comments -------------------------------------------------------------------------------

    // Before `line_comment`, which is as long.
    doc_comment: (_) => token(/\/\/(\/([^\/\n][^\n]*)?|![^\n]*)/),
    line_comment: (_) => token(/\/\/[^\n]*/),
  },
});
