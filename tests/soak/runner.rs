//! Episodes in sequence, for some seconds.

use crate::calls::Layer;
use crate::check::Fault;
use crate::common::host::open;
use crate::episode::Episode;
use crate::log::{Finding, Log, Tally, found};
use crate::random::Random;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Frames of an episode.
const FRAMES: usize = 50;

/// Plays an episode. A failure has the last actions.
fn episode(seed: u64, fault: Fault) -> Result<Tally, Finding> {
    let layer = Layer::take();
    let host = open();
    let raw = layer.device(&host.instance, &host.device);
    layer.fail_at(usize::MAX);
    let mut log = Log::new(seed);
    let played = Episode::new((&layer, &host, &raw), &mut log, Random::of(seed), fault);
    let played = played.and_then(|mut episode| {
        episode.compares = variable("REVMAP_SOAK_COMPARES") != Some(0);
        episode.play(FRAMES)
    });
    played.map_err(|found| Finding(format!("{found}\n{}", log.text())))?;
    let (alive, messages) = (layer.alive(), host.take_messages());
    if alive != 0 || !messages.is_empty() {
        return found(format!("at the end {alive} handles are left, {messages:?}"));
    }
    log.forget();
    Ok(std::mem::take(&mut log.tally))
}

/// A number of the environment.
fn variable(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(
        text.parse()
            .unwrap_or_else(|e| panic!("{name}={text}: {e}")),
    )
}

#[test]
fn a_random_host_draws_what_fresh_renderers_draw() {
    let seconds = variable("REVMAP_SOAK_SECONDS").unwrap_or(20);
    let clock = || SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    // Far from the seeds of other runs.
    let seed = variable("REVMAP_SOAK_SEED").unwrap_or_else(|| clock().as_millis() as u64 * 1000);
    let (start, mut tally) = (Instant::now(), Tally::default());
    let mut next = seed;
    while start.elapsed() < Duration::from_secs(seconds) {
        let began = Instant::now();
        match episode(next, Fault::None) {
            Ok(counted) => {
                println!("episode {next}: {:.1} s", began.elapsed().as_secs_f64());
                tally.add(counted);
            }
            Err(found) => panic!("REVMAP_SOAK_SEED={next} repeats it: {found}"),
        }
        next += 1;
    }
    println!("episodes {seed} to {}: {tally}", next - 1);
    let counted = match variable("REVMAP_SOAK_COMPARES") {
        Some(0) => "drawn",
        _ => "compared with hits",
    };
    assert!(tally.of(counted) > 0, "{tally}");
}

/// The comparison fails for each fault that is planted in it.
#[test]
fn a_planted_fault_is_found() {
    for fault in [Fault::Color, Fault::Texture, Fault::Object, Fault::Copy] {
        let found = (0..20).find_map(|seed| episode(seed, fault).err());
        let found = found.unwrap_or_else(|| panic!("{fault:?} is not found"));
        assert!(found.0.contains("pixels differ"), "{fault:?}: {found}");
    }
}
