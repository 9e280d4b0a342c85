//! The actions of the host on one renderer.

use crate::episode::Episode;
use crate::log::{Finding, found};
use crate::model::Thing;
use crate::values::{copies, many, placement};
use crate::views;
use revmap::error::ErrorKind;
use revmap::gpu::{HostImage, ObjectId, Renderer};
use revmap::scene::{Object, Offset, Placement, Shadow};

/// Names and weights.
const ACTIONS: [(&str, f64); 28] = [
    ("add", 12.0),
    ("remove", 5.0),
    ("set look", 8.0),
    ("set equal", 2.0),
    ("set placement and copies", 3.0),
    ("set_offset", 6.0),
    ("set_placement", 8.0),
    ("set_instances", 6.0),
    ("set_mask", 4.0),
    ("set_color_image", 3.0),
    ("set_slope_image", 2.0),
    ("set_height_image", 1.0),
    ("set_lighting", 4.0),
    ("remove and add", 3.0),
    ("add and remove", 1.0),
    ("add a thousand", 0.2),
    ("remove most", 3.0),
    ("remove all", 0.3),
    ("thousands of copies", 0.3),
    ("prewarm", 2.0),
    ("prewarm on a thread", 1.0),
    ("hide_until_compiled", 1.0),
    ("plan", 2.0),
    ("refused values", 2.0),
    ("other images", 1.0),
    ("other profile", 1.0),
    ("renderer", 0.6),
    ("target", 1.0),
];

/// More objects than this are removed again.
const MANY: usize = 16;

/// Sets an image of an object.
type Set = fn(&mut Renderer, ObjectId, Option<HostImage>) -> revmap::Result<()>;

/// Software drivers take seconds for shadows of more copies than this.
const SLOW: usize = 800;

impl Episode<'_> {
    /// Does some actions on each player.
    pub fn act_on_all(&mut self) -> Result<(), Finding> {
        for player in 0..self.players.len() {
            for _ in 0..self.dice.pick(&[0, 1, 1, 2, 3, 5]) {
                self.act(player)?;
            }
        }
        Ok(())
    }

    /// Does one action on a player.
    pub fn act(&mut self, n: usize) -> Result<(), Finding> {
        // A renderer that is about to be dropped may have lost some values.
        if self.players[n].spoilt {
            return Ok(());
        }
        let (mut name, _) = ACTIONS[self.dice.weighed(ACTIONS.iter().map(|a| a.1))];
        let count = self.players[n].model.things.len();
        if count > MANY && self.dice.chance(0.2) {
            name = "remove most";
        }
        let thing = self.dice.below(count);
        self.log.note(format!("{n}: {name}, {thing} of {count}"));
        self.log.tally.count(name, 1);
        match name {
            "prewarm" | "prewarm on a thread" | "hide_until_compiled" => self.warm(n, name),
            "plan" | "renderer" | "target" | "other images" | "other profile" => {
                self.whole(n, name)
            }
            "add"
            | "remove and add"
            | "add and remove"
            | "add a thousand"
            | "thousands of copies"
            | "remove most"
            | "remove all"
            | "set_lighting" => self.come_and_go(n, name, thing),
            _ if count == 0 => Ok(()),
            "refused values" => self.refuse(n, thing),
            _ => self.change(n, name, thing),
        }
    }

    /// Changes of all objects.
    fn come_and_go(&mut self, n: usize, name: &str, thing: usize) -> Result<(), Finding> {
        let count = self.players[n].model.things.len();
        self.players[n].changed = true;
        let shadows = self.players[n].model.lighting.shadow != Shadow::Off;
        match name {
            "add" if count < MANY => {
                let object = self.palette.object(&mut self.dice);
                self.add(n, object)?;
            }
            "remove and add" if count > 0 => {
                let object = self.players[n].thing(thing).object.clone();
                self.remove(n, thing)?;
                self.add(n, object)?;
            }
            "add and remove" => {
                let object = self.palette.object(&mut self.dice);
                self.add(n, object)?;
                self.remove(n, count)?;
            }
            "add a thousand" if count < MANY && !shadows => {
                let one = self.palette.object(&mut self.dice);
                for _ in 0..1000 {
                    let mut place = placement(&mut self.dice);
                    place.scale *= 0.1;
                    let mut object = one.clone();
                    (object.placement, object.instances) = (place, Vec::new().into());
                    self.add(n, object)?;
                }
            }
            "thousands of copies" if count > 0 && !shadows => {
                let few = self.dice.below(2000);
                let all = many(&mut self.dice, 1500 + few);
                self.set_instances(n, thing, all)?;
            }
            "remove most" if count > MANY => {
                while self.players[n].model.things.len() > 4 {
                    let last = self.players[n].model.things.len();
                    let one = self.dice.below(last);
                    self.remove(n, one)?;
                }
            }
            "remove all" => (0..count).try_for_each(|_| self.remove(n, 0))?,
            "set_lighting" => {
                let mut lighting = self.palette.lighting(&mut self.dice);
                if self.players[n].model.copies() > SLOW {
                    lighting.shadow = Shadow::Off;
                }
                self.players[n].renderer.set_lighting(&lighting)?;
                self.players[n].model.lighting = lighting;
            }
            _ => {}
        }
        Ok(())
    }

    fn add(&mut self, n: usize, object: Object) -> Result<(), Finding> {
        let player = &mut self.players[n];
        let id = player.renderer.add(object.clone())?;
        player.model.things.push(Thing::new(id, object));
        Ok(())
    }

    fn remove(&mut self, n: usize, thing: usize) -> Result<(), Finding> {
        let player = &mut self.players[n];
        let id = player.model.things.remove(thing).id;
        player.renderer.remove(id)?;
        // An object that is gone is refused.
        match player.renderer.set_mask(id, 1) {
            Err(e) if e.kind == ErrorKind::Usage => Ok(()),
            other => found(format!("a removed object was changed: {other:?}")),
        }
    }

    fn set_instances(
        &mut self,
        n: usize,
        thing: usize,
        all: revmap::scene::Copies,
    ) -> Result<(), Finding> {
        let player = &mut self.players[n];
        let id = player.thing(thing).id;
        player.renderer.set_instances(id, all.clone())?;
        player.thing(thing).object.instances = all;
        Ok(())
    }

    /// Changes of one object.
    fn change(&mut self, n: usize, name: &str, thing: usize) -> Result<(), Finding> {
        let (dice, palette) = (&mut self.dice, &self.palette);
        let player = &mut self.players[n];
        player.changed = true;
        let Thing { id, object, .. } = player.thing(thing).clone();
        match name {
            "remove" => return self.remove(n, thing),
            "set look" | "set placement and copies" | "set equal" => {
                let mut object = object;
                match name {
                    "set look" => palette.change_look(dice, &mut object),
                    "set equal" => {}
                    _ => object.placement = placement(dice),
                }
                if name == "set placement and copies" || dice.chance(0.1) && name != "set equal" {
                    object.instances = copies(dice);
                }
                player.renderer.set(id, object.clone())?;
                player.thing(thing).object = object;
            }
            "set_offset" => {
                let offset = palette.offset(dice);
                player.renderer.set_offset(id, offset)?;
                player.thing(thing).object.offset = offset;
            }
            "set_placement" => {
                let place = placement(dice);
                player.renderer.set_placement(id, place)?;
                player.thing(thing).object.placement = place;
            }
            "set_instances" => {
                let all = match dice.chance(0.3) {
                    true => moved(&object),
                    false => copies(dice),
                };
                return self.set_instances(n, thing, all);
            }
            "set_mask" => {
                let mask = dice.pick(&[u32::MAX, u32::MAX, u32::MAX, 1, 2, 0]);
                player.renderer.set_mask(id, mask)?;
                player.thing(thing).mask = mask;
            }
            "set_color_image" | "set_slope_image" | "set_height_image" if palette.textured => {
                let (kind, set): (usize, Set) = match name {
                    "set_color_image" => (0, Renderer::set_color_image),
                    "set_slope_image" => (1, Renderer::set_slope_image),
                    _ => (2, Renderer::set_height_image),
                };
                let image = dice.chance(0.6).then(|| dice.pick(&palette.images[kind]));
                set(&mut player.renderer, id, image.clone())?;
                match kind {
                    0 => player.thing(thing).color = image,
                    _ => player.thing(thing).relief = image.map(|image| (image, kind == 2)),
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Values that are refused change nothing.
    fn refuse(&mut self, n: usize, thing: usize) -> Result<(), Finding> {
        let which = self.dice.below(5);
        let player = &mut self.players[n];
        let Thing { id, mut object, .. } = player.thing(thing).clone();
        let extend = f64::NAN;
        let wrong = Placement {
            scale: glam::DVec3::ZERO,
            ..object.placement
        };
        let renderer = &mut player.renderer;
        let result = match which {
            0 => {
                object.offset.extend = extend;
                object.color = [1.0, 0.0, 1.0];
                renderer.set(id, object)
            }
            1 => renderer.set_offset(
                id,
                Offset {
                    extend,
                    ..object.offset
                },
            ),
            2 => renderer.set_placement(id, wrong),
            3 => renderer.set_instances(id, vec![object.placement, wrong]),
            _ => {
                object.map_rows = 0;
                renderer.add(object).map(|_| ())
            }
        };
        match result {
            Err(e) if e.kind == ErrorKind::Content => Ok(()),
            other => found(format!("wrong values {which} gave {other:?}")),
        }
    }

    fn warm(&mut self, n: usize, name: &str) -> Result<(), Finding> {
        let hides = self.dice.chance(0.5);
        let player = &mut self.players[n];
        match name {
            "hide_until_compiled" => {
                player.hides = hides;
                player.renderer.hide_until_compiled(hides);
            }
            _ => {
                player.join()?;
                let prewarm = match player.renderer.prewarm() {
                    Ok(prewarm) => prewarm,
                    Err(e) => return self.refused(n, e),
                };
                let compile = move || prewarm.compile();
                match name {
                    "prewarm" => compile()?,
                    _ => player.compiles = Some(std::thread::spawn(compile)),
                }
                player.prewarmed = player.model.techniques();
            }
        }
        Ok(())
    }

    fn whole(&mut self, n: usize, name: &str) -> Result<(), Finding> {
        match name {
            "plan" => {
                let kind = self.players[n].kind.clone();
                let seen = views::random(&mut self.dice, &kind, None, None);
                let planned = self.players[n].renderer.plan(&seen.view);
                planned.or_else(|e| self.refused(n, e))
            }
            "other images" => {
                self.palette.change_images(&mut self.dice);
                Ok(())
            }
            "other profile" => {
                self.palette.change_profile(&mut self.dice);
                Ok(())
            }
            "target" => {
                self.players[n].depths = self.dice.chance(0.5);
                Ok(())
            }
            // After this frame.
            _ => {
                self.players[n].spoilt = true;
                Ok(())
            }
        }
    }
}

/// The copies of an object, half of them elsewhere.
fn moved(object: &Object) -> revmap::scene::Copies {
    let mut all = object.instances.clone();
    for place in all.iter_mut().step_by(2) {
        place.position.z += 0.1;
    }
    all
}
