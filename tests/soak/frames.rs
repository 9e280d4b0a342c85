//! The frames of an episode: prepared, recorded, submitted.

use crate::check::Drawn;
use crate::episode::Episode;
use crate::log::{Finding, found};
use crate::recording::Recording;
use crate::views::{self, Seen};
use ash::vk;
use revmap::error::{Error, ErrorKind};
use revmap::gpu::PreparedFrame;
use revmap::scene::Shadow;

/// A prepared view of a player.
struct Ready {
    player: usize,
    slot: usize,
    frame: PreparedFrame,
    drawn: Drawn,
}

impl Episode<'_> {
    pub fn frame(&mut self) -> Result<(), Finding> {
        let n = self.next;
        self.next = (n + 1) % self.flights.len();
        self.wait(n)?;
        self.number += 1;
        let [early, cmd] = self.flights[n].cmd;
        let split = self.dice.chance(0.15);
        let first = if split { early } else { cmd };
        let submitted = !self.dice.chance(0.08);
        self.begin(early);
        self.begin(cmd);
        let mut ready = Vec::new();
        for player in 0..self.players.len() {
            self.players[player].changed &= !submitted;
            for view in 0..self.players[player].views {
                let slot = n * self.players[player].views + view;
                ready.extend(self.prepare_view(first, player, slot)?);
            }
        }
        // Changes after `prepare` take effect in the next frame.
        if self.dice.chance(0.3) {
            self.act_on_all()?;
        }
        let drawn = self.record(cmd, ready)?;
        let fence = self.flights[n].fence;
        let device = &self.host.device;
        // SAFETY: the commands are recorded; the fence is of no other submission.
        unsafe {
            device.end_command_buffer(early).unwrap();
            device.end_command_buffer(cmd).unwrap();
            if submitted {
                let all = [early, cmd];
                let submit = [vk::SubmitInfo::default().command_buffers(&all)];
                device.reset_fences(&[fence]).unwrap();
                let queue = self.host.queue;
                device.queue_submit(queue, &submit, fence).unwrap();
            }
        }
        if submitted {
            self.flights[n].drawn = drawn;
        } else {
            self.log.note("the frame is not submitted");
            self.log.tally.count("not submitted", 1);
        }
        self.log.tally.count("frames", 1);
        self.after_frame()
    }

    fn begin(&self, cmd: vk::CommandBuffer) {
        let begin = vk::CommandBufferBeginInfo::default();
        // SAFETY: the commands have run, or were never submitted.
        unsafe { self.host.device.begin_command_buffer(cmd, &begin) }.unwrap();
    }

    /// Prepares a view in a slot, sometimes twice. `None` if that failed, as planted.
    fn prepare_view(
        &mut self,
        cmd: vk::CommandBuffer,
        n: usize,
        slot: usize,
    ) -> Result<Option<Ready>, Finding> {
        let times = 1 + usize::from(self.dice.chance(0.06));
        let mut ready = None;
        for time in 0..times {
            if self.players[n].spoilt {
                return Ok(None);
            }
            if time > 0 && self.dice.chance(0.5) {
                self.act(n)?;
            }
            let seen = self.view(n, slot);
            let (number, name) = (self.number, seen.name);
            self.log
                .note(format!("{n}: frame {number} in slot {slot}, {name}"));
            let frame = self.prepare(cmd, n, slot, &seen)?;
            let player = &mut self.players[n];
            player.seen[slot] = Some(seen);
            let drawn = || Drawn {
                kind: player.kind.clone(),
                model: player.model.clone(),
                seen,
                depths: player.depths,
                paths: player.renderer.draw_paths(),
                planes: Vec::new(),
                name: format!("{n}: frame {number} in slot {slot}"),
            };
            ready = frame.map(|frame| Ready {
                player: n,
                slot,
                frame,
                drawn: drawn(),
            });
        }
        Ok(ready)
    }

    fn view(&mut self, n: usize, slot: usize) -> Seen {
        let player = &self.players[n];
        if let Some(seen) = player.seen[slot]
            && self.dice.chance(0.3)
        {
            return seen;
        }
        let things = &player.model.things;
        let inside = match things.is_empty() {
            true => None,
            false => {
                let places = things[self.dice.below(things.len())].object.placements();
                Some(places[self.dice.below(places.len())])
            }
        };
        let slots = player.seen.len();
        let last = player.seen[(slot + slots - player.views) % slots];
        let last = last.filter(|_| player.kind.has_motion()).map(|l| l.view);
        views::random(&mut self.dice, &player.kind, inside, last.as_ref())
    }

    fn prepare(
        &mut self,
        cmd: vk::CommandBuffer,
        n: usize,
        slot: usize,
        seen: &Seen,
    ) -> Result<Option<PreparedFrame>, Finding> {
        let planted = self.plant(n);
        let before = self.device.pipelines_compiled();
        let player = &mut self.players[n];
        player.canvases[slot].lend(&mut player.renderer, player.depths);
        player.stale = player.tokens[slot].take().or(player.stale.take());
        // SAFETY: `cmd` is recording outside of a pass; the slot's last frame was waited for, or
        // was not submitted.
        let result = unsafe { player.renderer.prepare(cmd, slot, &seen.view) };
        let failed = self.layer.failed();
        self.layer.fail_at(usize::MAX);
        self.device.set_memory_budget(None);
        let compiled = self.device.pipelines_compiled() - before;
        match result {
            // The allocator tries other memory, of which there may be the same.
            Ok(_) if failed.is_some_and(|call| call != "vkAllocateMemory") => {
                found(format!("{failed:?} failed, and prepare did not"))
            }
            Ok(frame) => {
                self.count_compiled(n, &frame, compiled)?;
                Ok(Some(frame))
            }
            Err(e) if planted && e.kind == ErrorKind::OutOfDeviceMemory => {
                let call = failed.unwrap_or("budget");
                self.log.note(format!("{n}: prepare failed by {call}"));
                self.log.tally.count(format!("failed by {call}"), 1);
                let renderer = &mut self.players[n].renderer;
                // SAFETY: as above.
                Ok(Some(unsafe { renderer.prepare(cmd, slot, &seen.view) }?))
            }
            Err(e) => self.refused(n, e).map(|()| None),
        }
    }

    /// Takes an error that valid values may give: more shapes than shadows between them can have.
    pub fn refused(&mut self, n: usize, error: Error) -> Result<(), Finding> {
        if error.kind != ErrorKind::Content || error.key.as_deref() != Some("shadow") {
            return Err(error.into());
        }
        self.log.note(format!("{n}: {error}"));
        self.log.tally.count("too many shadows", 1);
        self.players[n].model.lighting.shadow = Shadow::Off;
        self.players[n].spoilt = true;
        Ok(())
    }

    /// Counts pipelines that a frame compiled, or hidden parts, after all were compiled.
    fn count_compiled(
        &mut self,
        n: usize,
        frame: &PreparedFrame,
        compiled: u64,
    ) -> Result<(), Finding> {
        let player = &self.players[n];
        let (known, now) = (&player.prewarmed, player.model.techniques());
        // In shadows one pipeline may search objects of several techniques.
        let shadows = player.model.lighting.shadow != Shadow::Off;
        let is_known = now.is_subset(known) && (!shadows || now == *known);
        // Fresh renderers on the same device compile for this one.
        let alone = self.apart.is_some() || !self.compares;
        if !is_known || player.compiles.is_some() || !alone {
            return Ok(());
        }
        let hidden = frame.statistics().hidden;
        self.log.tally.count("prepared after prewarm", 1);
        self.log.tally.count("compiled after prewarm", compiled);
        self.log.tally.count("hidden after prewarm", hidden.into());
        if compiled + u64::from(hidden) > 0 {
            let text = format!("{n}: {compiled} compiled, {hidden} hidden after prewarm");
            return found(text);
        }
        Ok(())
    }

    /// Sometimes makes a Vulkan call fail, or limits the memory. Returns true if so.
    fn plant(&mut self, n: usize) -> bool {
        let busy = self.players.iter().any(|p| p.compiles.is_some());
        // A frame that has nothing to change allocates nothing.
        let chance = if self.players[n].fresh() { 0.2 } else { 0.02 };
        if busy || !self.dice.chance(chance) {
            return false;
        }
        match self.dice.chance(0.7) {
            true => {
                let most = self.dice.pick(&[2, 5, 20]);
                self.layer.fail_at(self.dice.below(most));
            }
            false => {
                let room = self.dice.pick(&[0, 1000, 100_000]);
                let used = self.device.memory_use().total();
                self.device.set_memory_budget(Some(used + room));
            }
        }
        true
    }

    /// Prepares on a lost device.
    pub fn prepare_lost(&mut self, n: usize) -> Result<(), Finding> {
        let seen = self.view(n, 0);
        let cmd = self.flights[0].cmd[0];
        self.begin(cmd);
        // SAFETY: all frames have run, and the commands are never submitted.
        let result = unsafe { self.players[n].renderer.prepare(cmd, 0, &seen.view) };
        // SAFETY: `cmd` is recording; another player begins it again.
        let _ = unsafe { self.host.device.end_command_buffer(cmd) };
        match result {
            Err(e) if e.kind == ErrorKind::DeviceLost => {
                self.log.tally.count("lost", 1);
                Ok(())
            }
            Err(e) if e.key.as_deref() == Some("shadow") => Ok(()),
            // Nothing was allocated.
            Ok(_) => Ok(()),
            Err(e) => found(format!("prepare on a lost device: {e}")),
        }
    }

    /// Records all prepared frames. Returns what each draws.
    fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        ready: Vec<Ready>,
    ) -> Result<Vec<(usize, usize, Drawn)>, Finding> {
        let mut all = Vec::new();
        for (n, one) in ready.iter().enumerate() {
            let player = &self.players[one.player];
            let times = 1 + usize::from(self.dice.chance(0.1));
            let other = &ready[(n + 1) % ready.len()];
            let foreign = Some(other).filter(|other| other.player != one.player);
            let refused = player.stale.iter().chain(foreign.map(|f| &f.frame));
            let recording = Recording {
                renderer: &player.renderer,
                frame: &one.frame,
                times,
                warms: self.dice.chance(0.1),
                refused: refused.collect(),
            };
            // SAFETY: `cmd` is recording outside of a pass; the wait for the flight comes before all
            // that it reads is dropped.
            unsafe {
                let canvas = &player.canvases[one.slot];
                recording.draw(self.host, cmd, canvas, &one.drawn.seen)?;
            }
        }
        for one in ready {
            if one.frame.statistics().hidden > 0 {
                self.log.tally.count("frames with hidden parts", 1);
            } else {
                all.push((one.player, one.slot, one.drawn));
            }
            // The next token of the slot makes this one stale.
            self.players[one.player].tokens[one.slot] = Some(one.frame);
        }
        Ok(all)
    }
}
