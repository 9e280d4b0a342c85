//! An episode: frames in flight of one or two renderers on a device, and random actions between.
//! `frames.rs` prepares and records them.

use crate::calls::Layer;
use crate::check::{Drawn, Fault, check};
use crate::common::host::{Commands, Host, borrow_through};
use crate::log::{Finding, Log, found};
use crate::player::Player;
use crate::random::Random;
use crate::values::Palette;
use ash::vk;
use revmap::gpu::Device;

/// A frame of all players and views.
pub struct Flight {
    /// Commands that are submitted in this order. The first ones are used if frames are prepared in
    /// other commands than they are recorded in.
    pub cmd: [vk::CommandBuffer; 2],
    pub fence: vk::Fence,
    /// The views that the commands draw, each with the player and the slot.
    pub drawn: Vec<(usize, usize, Drawn)>,
}

// In the order of destruction: renderers before images before the device.
pub struct Episode<'a> {
    pub players: Vec<Player<'a>>,
    pub palette: Palette<'a>,
    pub flights: Vec<Flight>,
    _commands: Commands<'a>,
    pub next: usize,
    pub number: usize,
    /// Frames that have run and are not compared yet.
    pending: Vec<Drawn>,
    pub device: Device,
    /// Another device over the same handles, for fresh renderers: they compile nothing for the
    /// players.
    pub apart: Option<Device>,
    pub dice: Random,
    pub log: &'a mut Log,
    pub layer: &'a Layer,
    fault: Fault,
    /// False if frames are only drawn.
    pub compares: bool,
    pub host: &'a Host,
}

/// More frames than this are compared at once.
const MOST_PENDING: usize = 8;

impl<'a> Episode<'a> {
    pub fn new(
        (layer, host, raw): (&'a Layer, &'a Host, &ash::Device),
        log: &'a mut Log,
        mut dice: Random,
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
        let commands = Commands::new(host, vk::CommandBufferLevel::PRIMARY, 2 * frames).unwrap();
        Ok(Self {
            players,
            palette,
            flights: flights(host, &commands),
            _commands: commands,
            next: 0,
            number: 0,
            pending: Vec::new(),
            apart: apart.transpose()?,
            device,
            dice,
            log,
            layer,
            fault,
            compares: true,
            host,
        })
    }

    /// Plays this many frames and compares all.
    pub fn play(&mut self, frames: usize) -> Result<(), Finding> {
        for _ in 0..frames {
            self.act_on_all()?;
            self.frame()?;
        }
        self.players.iter_mut().try_for_each(Player::join)?;
        self.wait_for_all()?;
        self.check_all()?;
        let compiled = self.device.pipelines_compiled();
        self.log.tally.count("pipelines", compiled);
        match self.dice.chance(0.1) {
            true => self.lose(),
            false => Ok(()),
        }
    }

    /// Loses the device. Errors of later calls must name the loss.
    fn lose(&mut self) -> Result<(), Finding> {
        self.log.note("the device is lost");
        self.layer.lose(Some("vkAllocateMemory"));
        let mut result = Ok(());
        for n in 0..self.players.len() {
            let object = self.palette.object(&mut self.dice);
            for _ in 0..1000 {
                self.players[n].renderer.add(object.clone())?;
            }
            result = result.and(self.prepare_lost(n));
        }
        self.layer.lose(None);
        result
    }

    pub fn after_frame(&mut self) -> Result<(), Finding> {
        let messages = self.host.take_messages();
        if let Some(message) = messages.first() {
            return found(format!("{} messages: {message}", messages.len()));
        }
        self.palette.free_unheld(self.flights.len());
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
        self.players[n].make_again(&self.device)
    }

    /// Waits for a flight, and keeps what it drew.
    pub fn wait(&mut self, n: usize) -> Result<(), Finding> {
        let flight = &mut self.flights[n];
        // SAFETY: the fence is signalled by the last submission, or from the beginning.
        unsafe {
            self.host
                .device
                .wait_for_fences(&[flight.fence], true, u64::MAX)
        }
        .unwrap();
        for (player, slot, mut drawn) in std::mem::take(&mut flight.drawn) {
            drawn.planes = self.players[player].canvases[slot].planes();
            self.log.tally.count("drawn", 1);
            self.pending.extend(self.compares.then_some(drawn));
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
}

/// Frames in flight, of two commands each.
fn flights(host: &Host, commands: &Commands<'_>) -> Vec<Flight> {
    let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
    let flight = |cmd: &[vk::CommandBuffer; 2]| Flight {
        cmd: *cmd,
        // SAFETY: a plain creation, destroyed in Drop.
        fence: unsafe { host.device.create_fence(&signaled, None) }.unwrap(),
        drawn: Vec::new(),
    };
    commands.raw.as_chunks().0.iter().map(flight).collect()
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
        }
    }
}
