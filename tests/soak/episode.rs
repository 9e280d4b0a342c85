//! An episode: frames in flight of one or two renderers on a device, and random actions between.

use crate::calls::Layer;
use crate::check::{Drawn, Fault, check};
use crate::common::host::{Host, borrow_through};
use crate::dice::Dice;
use crate::known::mended;
use crate::log::{Finding, Log, found};
use crate::player::Player;
use crate::surface::Recording;
use crate::values::Palette;
use crate::views::{self, Seen};
use ash::vk;
use revmap::error::ErrorKind;
use revmap::gpu::{Device, DrawPath, PreparedFrame};

/// A frame of all players and views.
#[derive(Default)]
struct Flight {
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
    /// What the commands draw, with the player and the slot.
    drawn: Vec<(usize, usize, Drawn)>,
}

/// A prepared view of a player.
struct Ready {
    player: usize,
    slot: usize,
    seen: Seen,
    frame: PreparedFrame,
    paths: Vec<DrawPath>,
}

// In the order of destruction: renderers before images before the device.
pub struct Episode<'a> {
    pub players: Vec<Player<'a>>,
    pub palette: Palette<'a>,
    flights: Vec<Flight>,
    pool: vk::CommandPool,
    next: usize,
    number: usize,
    /// Frames that have run and are not compared yet.
    pending: Vec<Drawn>,
    pub device: Device,
    /// Another device over the same handles, for fresh renderers: they compile nothing for the
    /// players.
    apart: Option<Device>,
    pub dice: Dice,
    pub log: &'a mut Log,
    pub layer: &'a Layer,
    fault: Fault,
    pub host: &'a Host,
}

/// More frames than this are compared at once.
const MOST_PENDING: usize = 8;

impl<'a> Episode<'a> {
    pub fn new(
        (layer, host, raw): (&'a Layer, &'a Host, &ash::Device),
        log: &'a mut Log,
        mut dice: Dice,
        fault: Fault,
    ) -> Result<Self, Finding> {
        let device = borrow_through(host, &host.instance, raw)?;
        let apart = dice.chance(0.3);
        let apart = apart.then(|| borrow_through(host, &host.instance, raw));
        let frames = dice.pick(&[1, 2, 2, 3]);
        let count = 1 + usize::from(dice.chance(0.3));
        let palette = Palette::new(host, &mut dice);
        let players = (0..count).map(|_| Player::new((host, &device), &mut dice, frames));
        let players = players.collect::<Result<Vec<_>, _>>()?;
        for player in &players {
            log.note(format!("{} views by {:?}", player.views, player.kind));
        }
        let (pool, flights) = flights(host, frames);
        Ok(Self {
            players,
            palette,
            flights,
            pool,
            next: 0,
            number: 0,
            pending: Vec::new(),
            apart: apart.transpose()?,
            device,
            dice,
            log,
            layer,
            fault,
            host,
        })
    }

    /// Plays this many frames and compares all.
    pub fn play(&mut self, frames: usize) -> Result<(), Finding> {
        for _ in 0..frames {
            for player in 0..self.players.len() {
                for _ in 0..self.dice.pick(&[0, 1, 1, 2, 3, 5]) {
                    self.act(player)?;
                }
            }
            self.frame()?;
        }
        self.players.iter_mut().try_for_each(Player::join)?;
        self.wait_for_all()?;
        self.check_all()
    }

    fn frame(&mut self) -> Result<(), Finding> {
        let n = self.next;
        self.next = (n + 1) % self.flights.len();
        self.wait(n)?;
        self.number += 1;
        let cmd = self.flights[n].cmd;
        let begin = vk::CommandBufferBeginInfo::default();
        // SAFETY: the commands have run, or were never submitted.
        unsafe { self.host.device.begin_command_buffer(cmd, &begin) }.unwrap();
        let mut ready = Vec::new();
        for player in 0..self.players.len() {
            for view in 0..self.players[player].views {
                let slot = n * self.players[player].views + view;
                ready.extend(self.prepare_view(cmd, player, slot)?);
            }
        }
        let drawn = self.record(cmd, ready)?;
        let may_drop = mended("never submitted") || self.players.iter().all(|p| !p.changed);
        let submitted = !(may_drop && self.dice.chance(0.08));
        // SAFETY: the commands are recorded; the fence is of no other submission.
        unsafe {
            let (device, fence) = (&self.host.device, self.flights[n].fence);
            device.end_command_buffer(cmd).unwrap();
            if submitted {
                let all = [cmd];
                let submit = [vk::SubmitInfo::default().command_buffers(&all)];
                device.reset_fences(&[fence]).unwrap();
                device
                    .queue_submit(self.host.queue, &submit, fence)
                    .unwrap();
            }
        }
        if submitted {
            self.flights[n].drawn = drawn;
            self.players.iter_mut().for_each(|p| p.changed = false);
        } else {
            self.log.note("the frame is not submitted");
            self.log.tally.count("not submitted", 1);
        }
        self.log.tally.count("frames", 1);
        self.after_frame()
    }

    fn after_frame(&mut self) -> Result<(), Finding> {
        let messages = self.host.take_messages();
        if let Some(message) = messages.first() {
            return found(format!("{} messages: {message}", messages.len()));
        }
        for n in 0..self.players.len() {
            if self.players[n].spoilt {
                self.make_again(n)?;
            }
            let ends = if self.players[n].kind.has_motion() {
                0.8
            } else {
                0.1
            };
            if self.dice.chance(ends) {
                self.log.note(format!("{n}: end_frame"));
                self.players[n].renderer.end_frame();
                self.players[n].model.end_frame();
            }
        }
        if self.pending.len() > MOST_PENDING || self.dice.chance(0.2) {
            self.check_all()?;
        }
        Ok(())
    }

    pub fn make_again(&mut self, n: usize) -> Result<(), Finding> {
        self.log.note(format!("{n}: the renderer is made again"));
        self.log.tally.count("made again", 1);
        self.wait_for_all()?;
        self.players[n].make_again(self.host, &self.device)
    }

    /// Prepares a view in a slot, sometimes twice. `None` if that failed, as planted.
    fn prepare_view(
        &mut self,
        cmd: vk::CommandBuffer,
        n: usize,
        slot: usize,
    ) -> Result<Option<Ready>, Finding> {
        let twice = mended("prepared twice") || !self.players[n].changed;
        let times = 1 + usize::from(twice && self.dice.chance(0.06));
        let mut ready = None;
        for time in 0..times {
            if self.players[n].spoilt {
                return Ok(None);
            }
            if time > 0 && mended("prepared twice") && self.dice.chance(0.5) {
                self.act(n)?;
            }
            let seen = self.view(n, slot);
            let (number, name) = (self.number, seen.name);
            self.log
                .note(format!("{n}: frame {number} in slot {slot}, {name}"));
            ready = self.prepare(cmd, n, slot, &seen)?.map(|frame| Ready {
                player: n,
                slot,
                seen,
                frame,
                paths: self.players[n].renderer.draw_paths(),
            });
            self.players[n].seen[slot] = Some(seen);
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
        let last = last.filter(|_| player.kind.has_motion());
        views::random(
            &mut self.dice,
            &player.kind,
            inside,
            last.map(|l| l.view).as_ref(),
        )
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
            let again = !player.kind.compute || mended("recorded twice");
            let times = 1 + usize::from(again && self.dice.chance(0.1));
            let other = ready[(n + 1) % ready.len()..].first();
            let foreign = other.filter(|other| other.player != one.player);
            let refused = player.stale.iter().chain(foreign.map(|f| &f.frame));
            let recording = Recording {
                renderer: &player.renderer,
                frame: &one.frame,
                times,
                refused: refused.collect(),
            };
            // SAFETY: `cmd` is recording outside of a pass; the wait for the flight comes before all
            // that it reads is dropped.
            unsafe {
                let surface = &player.surfaces[one.slot];
                let shown = (&*player.kind, &one.seen);
                surface.draw(self.host, cmd, shown, player.words.last(), &recording)?;
            }
            let hidden = one.frame.statistics().hidden;
            if hidden > 0 {
                self.log.tally.count("frames with hidden parts", 1);
                continue;
            }
            let drawn = Drawn {
                kind: player.kind.clone(),
                model: player.model.clone(),
                seen: one.seen,
                depths: player.depths,
                paths: one.paths.clone(),
                planes: Vec::new(),
                name: format!("{}: frame {} in slot {}", one.player, self.number, one.slot),
            };
            all.push((one.player, one.slot, drawn));
        }
        for one in ready {
            // The next token of the slot makes this one stale.
            self.players[one.player].tokens[one.slot] = Some(one.frame);
        }
        Ok(all)
    }

    /// Waits for a flight, and keeps what it drew.
    fn wait(&mut self, n: usize) -> Result<(), Finding> {
        let flight = &mut self.flights[n];
        // SAFETY: the fence is signalled by the last submission, or from the beginning.
        unsafe {
            self.host
                .device
                .wait_for_fences(&[flight.fence], true, u64::MAX)
        }
        .unwrap();
        for (player, slot, mut drawn) in std::mem::take(&mut flight.drawn) {
            drawn.planes = self.players[player].surfaces[slot].read(&drawn.kind);
            self.pending.push(drawn);
        }
        Ok(())
    }

    pub fn wait_for_all(&mut self) -> Result<(), Finding> {
        (0..self.flights.len()).try_for_each(|n| self.wait(n))
    }

    fn check_all(&mut self) -> Result<(), Finding> {
        let device = self.apart.as_ref().unwrap_or(&self.device);
        for drawn in std::mem::take(&mut self.pending) {
            let same = check(self.host, device, &drawn, self.fault)?;
            let tally = &mut self.log.tally;
            tally.count("compared", 1);
            tally.count("compared with hits", u64::from(same.hits > 0));
            tally.count("other draw paths", u64::from(same.other_path));
            let name = drawn.seen.name;
            tally.count(format!("view {name}"), 1);
        }
        let messages = self.host.take_messages();
        match messages.first() {
            Some(first) => found(format!(
                "{} messages of fresh renderers: {first}",
                messages.len()
            )),
            None => Ok(()),
        }
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
        player.stale = player.tokens[slot].take().or(player.stale.take());
        // SAFETY: `cmd` is recording outside of a pass; the slot's last frame was waited for, or
        // was not submitted.
        let result = unsafe { player.renderer.prepare(cmd, slot, &seen.view) };
        let failed = self.layer.failed();
        self.layer.fail_at(usize::MAX);
        self.device.set_memory_budget(None);
        let compiled = self.device.pipelines_compiled() - before;
        let player = &mut self.players[n];
        if player.prewarmed && player.compiles.is_none() && self.apart.is_some() {
            self.log.tally.count("prepared after prewarm", 1);
            self.log.tally.count("compiled after prewarm", compiled);
            if mended("prewarm") && compiled > 0 {
                return found(format!(
                    "prepare compiled {compiled} pipelines after prewarm"
                ));
            }
        }
        match result {
            Ok(_) if failed.is_some() => found(format!("{failed:?} failed, and prepare did not")),
            Ok(frame) => Ok(Some(frame)),
            Err(e) if planted && e.kind == ErrorKind::OutOfDeviceMemory => {
                let call = failed.unwrap_or("budget");
                self.log.note(format!("{n}: prepare failed by {call}"));
                self.log.tally.count(format!("failed by {call}"), 1);
                if !mended("failed prepare") {
                    player.spoilt = true;
                    return Ok(None);
                }
                // SAFETY: as above.
                Ok(Some(unsafe {
                    player.renderer.prepare(cmd, slot, &seen.view)
                }?))
            }
            Err(e) if e.kind == ErrorKind::Content && e.key.as_deref() == Some("shadow") => {
                self.log.note(format!("{n}: {e}"));
                player.model.lighting.shadow = revmap::scene::Shadow::Off;
                player.spoilt = true;
                Ok(None)
            }
            Err(e) => Err(e.into()),
        }
    }

    /// Sometimes makes a Vulkan call fail, or limits the memory. Returns true if so.
    fn plant(&mut self, n: usize) -> bool {
        let busy = self.players.iter().any(|p| p.compiles.is_some());
        // A frame that has nothing to change allocates nothing.
        let chance = if self.players[n].changed { 0.05 } else { 0.01 };
        if busy || !self.dice.chance(chance) {
            return false;
        }
        match self.dice.chance(0.7) {
            true => self.layer.fail_at(self.dice.below(12)),
            false => {
                let room = self.dice.pick(&[0, 1000, 100_000]);
                let used = self.device.memory_use().total();
                self.device.set_memory_budget(Some(used + room));
            }
        }
        true
    }
}

/// Commands and fences of frames in flight.
fn flights(host: &Host, count: usize) -> (vk::CommandPool, Vec<Flight>) {
    let device = &host.device;
    // SAFETY: plain creations, destroyed in Drop.
    unsafe {
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(host.family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        let pool = device.create_command_pool(&pool, None).unwrap();
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .command_buffer_count(count as u32);
        let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        let all = device.allocate_command_buffers(&info).unwrap();
        let flight = |cmd| Flight {
            cmd,
            fence: device.create_fence(&signaled, None).unwrap(),
            drawn: Vec::new(),
        };
        (pool, all.into_iter().map(flight).collect())
    }
}

impl Drop for Episode<'_> {
    fn drop(&mut self) {
        let device = &self.host.device;
        // SAFETY: the device is waited for.
        unsafe {
            let _ = device.device_wait_idle();
            for flight in &self.flights {
                device.destroy_fence(flight.fence, None);
            }
            device.destroy_command_pool(self.pool, None);
        }
    }
}
