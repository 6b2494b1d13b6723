# `just` lists these; CI runs `.ci/run`.

# What has to pass before a commit.
check: fmt lint test

# Formatting, without changing anything.
fmt:
    cargo fmt --check

# All lints as errors.
lint:
    cargo clippy --all-targets -- -D warnings

# All tests.
test:
    cargo test --release

# What takes too long for every day: Z3 on all lengths, a thousand changed missions.
soak:
    DOSMC_SLOW=1 cargo test --release --test differential
    DOSMC_METAMORPHIC=1000 cargo test --release --test metamorphic

# Plans the paper's Fig. 2 into out/.
demo:
    cargo run --release -- solve examples/paper/fig2-4.dosm -o out

# Writes changed snapshots beside the old ones and goes through them one by one (needs cargo-insta).
review:
    cargo insta test --review

# Fails on changed, new and unused snapshots (needs cargo-insta).
snapshots:
    cargo insta test --check --unreferenced=reject

# Licences, sources and advisories of all dependencies (needs cargo-deny).
deny:
    cargo deny check

# Flies every example for 10⁸ robot-steps, and prints how fast and how near to each limit.
soak *ARGS:
    cargo build --release
    benches/soak.py {{ARGS}}
