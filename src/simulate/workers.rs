//! Threads: blocks of runs, worked on side by side and added up in their order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use super::Arena;
use super::inspect::{Findings, Inspector};
use super::way::Way;

/// Watches a simulation, from the thread that started it; only [`stop`](Observer::stop) is asked from all.
pub trait Observer: Sync {
    /// Whether to stop.
    fn stop(&self) -> bool {
        false
    }

    /// Hears how many runs are done, and of how many violations.
    fn progress(&self, _runs: u64, _violations: u64) {}

    /// Whether it wants to see every run.
    fn wants_ways(&self) -> bool {
        false
    }

    /// Sees a run, one way a robot; runs come in their order.
    fn see(&self, _run: u64, _ways: &[Way]) {}
}

/// So many robot-steps are a block of runs.
const BLOCK: u64 = 50_000;

/// A block that is done.
struct Block {
    index: u64,
    runs: u64,
    findings: Findings,
    ways: Vec<Vec<Way>>,
}

/// Makes all runs, or as many of the first as there is time for: how many, and what was found.
pub(super) fn work(arena: &Arena<'_>, observer: &dyn Observer) -> (u64, Findings) {
    let a_run = (arena.robots.len() * arena.steps).max(1) as u64;
    let size = if observer.wants_ways() { 1 } else { (BLOCK / a_run).max(1) };
    let blocks = arena.options.runs.div_ceil(size);
    let threads = arena.options.threads.max(1).min(usize::try_from(blocks).unwrap_or(usize::MAX)).max(1);
    let (next, stopped) = (AtomicU64::new(0), AtomicBool::new(false));
    let (sender, receiver) = sync_channel(2 * threads);
    thread::scope(|scope| {
        for _ in 0..threads {
            let sender = sender.clone();
            let (next, stopped) = (&next, &stopped);
            scope.spawn(move || work_on(arena, observer, (next, stopped), (blocks, size), &sender));
        }
        drop(sender);
        collect(receiver, observer)
    })
}

/// Takes one block after the other until there is none, or it is time to stop.
fn work_on(
    arena: &Arena<'_>,
    observer: &dyn Observer,
    (next, stopped): (&AtomicU64, &AtomicBool),
    (blocks, size): (u64, u64),
    sender: &SyncSender<Block>,
) {
    let mut inspector = Inspector::new(&arena.world);
    let mut ways = arena.ways();
    loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        if index >= blocks {
            return;
        }
        let mut block = Block { index, runs: 0, findings: Findings::default(), ways: Vec::new() };
        for run in index * size..((index + 1) * size).min(arena.options.runs) {
            if stopped.load(Ordering::Relaxed) || observer.stop() {
                stopped.store(true, Ordering::Relaxed);
                return;
            }
            arena.fly(run, &mut ways);
            inspector.inspect(run, &ways);
            block.runs += 1;
            if observer.wants_ways() {
                block.ways.push(ways.clone());
            }
        }
        block.findings = inspector.take();
        if sender.send(block).is_err() {
            return;
        }
    }
}

/// Adds blocks up in their order; those behind a missing one don't count.
fn collect(receiver: Receiver<Block>, observer: &dyn Observer) -> (u64, Findings) {
    let (mut runs, mut findings) = (0, Findings::default());
    let (mut waiting, mut expected) = (BTreeMap::new(), 0);
    for block in receiver {
        waiting.insert(block.index, block);
        while let Some(block) = waiting.remove(&expected) {
            expected += 1;
            for (run, ways) in (runs..).zip(&block.ways) {
                observer.see(run, ways);
            }
            runs += block.runs;
            findings.add(&block.findings);
            observer.progress(runs, findings.samples.all_shortfalls());
        }
    }
    (runs, findings)
}
