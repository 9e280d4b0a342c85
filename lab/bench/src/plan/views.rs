//! The views of a plan: solids, arrangements and forms of them.

use super::arrange::{army, avenue, distant, field, sparse, thousand};
use super::overrides::Overrides;
use super::suite::{self, Extent};
use super::values::list;
use crate::plan::view::{Framing, View};
use revmap::error::Result;
use revmap::maps::{BakeOptions, ColorMap, ShapeMap};
use revmap::scene::{Clip, Offset, Shadow};
use revmap::settings::name_of;
use std::sync::Arc;

/// An entry of a plan's views.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Views {
    /// Its name, by which entries of `measure` choose it.
    pub name: String,
    /// Which of the program's own solids.
    pub solids: Extent,
    /// Degrees above the horizon from which a solid is looked at.
    pub elevations: Vec<f64>,
    /// How much of the picture is solid.
    #[serde(deserialize_with = "list")]
    pub framings: Vec<Framing>,
    /// How copies are placed.
    pub arrange: Arrangement,
    /// Numbers of copies, of arrangements that have any number.
    pub copies: Vec<u32>,
    /// Forms of the surface; none: as the solid is.
    pub forms: Vec<Form>,
    /// Shadows that the scene has; none: as the scene says.
    #[serde(deserialize_with = "list")]
    pub shadows: Vec<Shadow>,
    /// True if the offset is another one in each frame that is timed.
    pub offset_moves: bool,
    /// The view's name in results, in place of the solid's.
    pub call: Option<String>,
}

impl Default for Views {
    fn default() -> Self {
        Self {
            name: String::new(),
            solids: Extent::First(1),
            elevations: vec![25.0],
            framings: vec![Framing::Whole],
            arrange: Arrangement::Alone,
            copies: Vec::new(),
            forms: Vec::new(),
            shadows: Vec::new(),
            offset_moves: false,
            call: None,
        }
    }
}

/// How copies of a solid are placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Arrangement {
    /// One solid.
    Alone,
    /// Copies on a square field, seen whole.
    Field,
    /// Small copies spread over a square, seen from far above.
    Sparse,
    /// Two lines that go into the distance.
    Avenue,
    /// Copies of three solids, 2 to 20 pixels high.
    Distant,
    /// Copies of ten solids, seen from within.
    Army,
    /// A thousand different solids on a square, seen whole.
    Thousand,
}

/// A form of the surface.
#[derive(Clone, Debug, Default, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Form {
    /// The ending of its views' names.
    pub name: String,
    /// The same key as in scene files.
    pub extend: f64,
    /// The same key as in scene files.
    pub bevel: f64,
    /// The same key as in scene files.
    #[serde(default = "whole")]
    pub chamfer: f64,
    /// True if `extend` and `bevel` are parts of the largest distance in the published map.
    pub relative: bool,
    /// True if the box cuts the solid.
    pub cut: bool,
    /// True if a chequered colour map covers it.
    pub textured: bool,
    /// The parameter that charts put it at.
    pub value: Option<f64>,
}

fn whole() -> f64 {
    1.0
}

impl Views {
    /// Applies what the command line names.
    pub(crate) fn apply(&mut self, given: &Overrides) {
        if let Some(solids) = &given.solids {
            self.solids = solids.clone();
        }
        if !given.elevations.is_empty() || !given.scenes.is_empty() {
            // A scene without a named elevation keeps its camera.
            self.elevations.clone_from(&given.elevations);
        }
        if !given.framings.is_empty() {
            self.framings.clone_from(&given.framings);
        }
    }

    /// The views; `scenes` take the place of the program's own solids.
    pub(crate) fn views(&self, scenes: &[View]) -> Result<Vec<View>> {
        let mut all = Vec::new();
        for view in self.arranged(scenes)? {
            // Framings in their own order, whatever that of the list.
            let framings = Framing::NAMES.map(|n| n.1).into_iter();
            for framing in framings.filter(|f| self.framings.contains(f)) {
                for view in self.formed(&view.clone().in_framing(framing))? {
                    all.extend(self.shadowed(view));
                }
            }
        }
        for view in &mut all {
            view.group.clone_from(&self.name);
            view.offset_moves = self.offset_moves;
            if let Some(name) = &self.call {
                view.name.clone_from(name);
            }
        }
        Ok(all)
    }

    fn arranged(&self, scenes: &[View]) -> Result<Vec<View>> {
        let each =
            |make: &dyn Fn(u32) -> Result<View>| self.copies.iter().map(|&n| make(n)).collect();
        match self.arrange {
            Arrangement::Army => return each(&army),
            Arrangement::Distant => return Ok(vec![distant()?]),
            Arrangement::Thousand => return Ok(vec![thousand()?]),
            _ => {}
        }
        let solids = self.solids(scenes)?;
        let mut all = Vec::new();
        for one in &solids {
            match self.arrange {
                Arrangement::Field => all.extend(each(&|n| Ok(field(one, n)))?),
                Arrangement::Sparse => all.extend(each(&|n| Ok(sparse(one, n)))?),
                Arrangement::Avenue => all.push(avenue(one)),
                _ => all.push(one.clone()),
            }
        }
        Ok(all)
    }

    fn solids(&self, scenes: &[View]) -> Result<Vec<View>> {
        if scenes.is_empty() {
            return suite::views(&self.solids, &self.elevations);
        }
        if self.elevations.is_empty() {
            return Ok(scenes.to_vec());
        }
        let all = scenes.iter().flat_map(|view| {
            let degrees = self.elevations.iter();
            degrees.map(|&degrees| view.clone().at_elevation(degrees))
        });
        Ok(all.collect())
    }

    /// A view with each kind of shadows; names end in all but `off`.
    fn shadowed(&self, view: View) -> Vec<View> {
        if self.shadows.is_empty() {
            return vec![view];
        }
        let with = |&shadow: &Shadow| {
            let mut view = view.clone();
            view.scene.shadow = shadow;
            if shadow != Shadow::Off {
                view.name += &format!("-{}", name_of(&Shadow::NAMES, &shadow));
            }
            view
        };
        self.shadows.iter().map(with).collect()
    }

    fn formed(&self, view: &View) -> Result<Vec<View>> {
        if self.forms.is_empty() {
            return Ok(vec![view.clone()]);
        }
        let largest = match self.forms.iter().any(|f| f.relative) {
            true => largest_distance(view)?,
            false => 1.0,
        };
        let forms = self.forms.iter();
        forms.map(|form| form.of(view, largest)).collect()
    }
}

impl Form {
    /// A view in this form.
    fn of(&self, view: &View, largest: f64) -> Result<View> {
        let unit = if self.relative { largest } else { 1.0 };
        let map = self.textured.then(chequered).transpose()?.map(Arc::new);
        let mut view = view.clone();
        for object in &mut view.scene.objects {
            object.offset = Offset {
                extend: unit * self.extend,
                bevel: unit * self.bevel,
                chamfer: self.chamfer,
            };
            if self.cut {
                object.clip = Clip::Box;
            }
            if map.is_some() {
                object.texturing.color_map.clone_from(&map);
            }
        }
        if !self.name.is_empty() {
            view.name = format!("{}-{}", view.name, self.name);
        }
        view.value = self.value;
        Ok(view)
    }
}

fn chequered() -> Result<ColorMap> {
    let texels = (0..64 * 64u32).map(|k| match (k / 8 + k / 512) % 2 {
        0 => [190, 150, 90, 255],
        _ => [90, 40, 20, 255],
    });
    ColorMap::from_texels(64, 64, texels.collect())
}

/// The largest distance that the published method's map of a view's solid holds, object units.
fn largest_distance(view: &View) -> Result<f64> {
    let mut largest = 0.0f64;
    for object in &view.scene.objects {
        let options = BakeOptions::new(revmap_files::BINARY, object.map_rows);
        let map = ShapeMap::bake(&object.profile, &options)?;
        largest = largest.max(f64::from(map.largest_distance()));
    }
    Ok(largest)
}
