// The words that src/scanner.c has to know.

#ifndef DOSM_WORDS_H_
#define DOSM_WORDS_H_

// What nothing can be called by, in the order of `externals` in grammar.js. Generated:
// words(declarations, prepositions, logic, truths, temporal, quantifiers, sets, temporal_letters)
static const char *const RESERVED[] = {"dosm", "mission", "param", "let", "workspace", "region",
  "obstacle", "opaque", "jammer", "base", "dynamics", "robot", "team", "separation", "connectivity",
  "horizon", "minimize", "goal", "define", "in", "at", "and", "or", "not", "true", "false", "always",
  "eventually", "next", "until", "release", "weak", "strong", "forall", "exists", "count", "all",
  "X", "F", "G", "U", "R", "W", "M"};

// Generated: words(units)
static const char *const UNITS[] = {"m", "cm", "mm", "km", "s", "ms", "min", "rad", "deg", "kg", "g",
  "N"};

#endif
