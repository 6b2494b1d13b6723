//! Three robots fly the plan of `examples/paper/fig2-4.dosm`: their generated controllers run against
//! a plant that is pushed about, and each robot's report travels hop by hop to the base, over a radio
//! on which jammers drown what crosses them.
//!
//! Ends with status 1 when something is not as planned: a report lost, a bound, jammer or wall
//! touched, robots too close, a goal not met again in time, or a warning of a monitor.
//!
//! ```text
//! firmware-host [--steps N] [--push FACTOR] [--direct]
//! ```
//!
//! `--push 1.5` disturbs everybody more than the plan allows, and `--direct` lets everybody call the
//! base without relays: both must fail.

use std::process::ExitCode;

use flight::{run, Scene, Settings};

/// The last step of the table that is printed; the summary is about all steps.
const SHOWN: usize = 16;
/// A goal has to be met again within so many steps: twice the plan.
const PATIENCE: u32 = 16;

fn main() -> ExitCode {
    let settings = match settings(std::env::args().skip(1)) {
        Ok(settings) => settings,
        Err(wrong) => {
            eprintln!("{wrong}\nusage: firmware-host [--steps N] [--push FACTOR] [--direct]");
            return ExitCode::from(2);
        }
    };
    println!("step   fleet[1]        fleet[2]        fleet[3]        hops  reports of");
    let summary = run(&settings, &mut show);
    print!("\n{summary}");
    if summary.good(PATIENCE) {
        println!("all as planned");
        ExitCode::SUCCESS
    } else {
        println!("NOT as planned");
        ExitCode::FAILURE
    }
}

/// What the command line asks for.
fn settings(mut args: impl Iterator<Item = String>) -> Result<Settings, String> {
    let mut settings = Settings::default();
    while let Some(option) = args.next() {
        let mut value = || args.next().ok_or(format!("{option} wants a number"));
        match option.as_str() {
            "--steps" => settings.steps = value()?.parse().map_err(|e| format!("--steps: {e}"))?,
            "--push" => settings.push = value()?.parse().map_err(|e| format!("--push: {e}"))?,
            "--direct" => settings.direct = true,
            other => return Err(format!("what is {other}?")),
        }
    }
    Ok(settings)
}

/// A line of the table.
fn show(scene: &Scene<'_>) {
    if scene.step > SHOWN {
        return;
    }
    print!("{:4}", scene.step);
    for (plant, decision) in scene.plants.iter().zip(scene.decisions) {
        let [x, y] = plant.position;
        print!("   ({x:5.2}, {y:5.2}){}", if decision.holds { ' ' } else { '!' });
    }
    let arrived = (1..).zip(scene.arrived).filter(|(_, arrived)| *arrived);
    let arrived: Vec<String> = arrived.map(|(robot, _)| robot.to_string()).collect();
    println!(" {:4}  {}", scene.hops, arrived.join(", "));
}
