//! Objects as the C interface describes them.

use crate::enums;
use crate::fault::{Outcome, RevmapResult, enter};
use crate::handle::Handle;
use crate::pointers::{list, optional_text};
use crate::profile::RevmapProfile;
use crate::structures::{described, fill, sized};
use crate::texture::{RevmapColorMap, RevmapHeightMap};
use crate::values::{RevmapOffset, RevmapPlacement, UPRIGHT};
use revmap::scene::{Material, Object, Offset, Placement, Specular, Texturing};
use std::ffi::c_char;

/// A solid of revolution, drawn once or as many copies. Defaults: revmap_object_defaults().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapObjectInfo {
    /// sizeof(RevmapObjectInfo).
    pub size: u32,
    /// Rows of its shape map.
    pub map_rows: u32,
    /// The profile that is turned about the axis. Objects that share a profile share its maps.
    pub profile: *const RevmapProfile,
    /// Name in messages, UTF-8; may be null.
    pub name: *const c_char,
    /// Colours in place of color; may be null.
    pub color_map: *const RevmapColorMap,
    /// Heights for bump mapping; may be null.
    pub height_map: *const RevmapHeightMap,
    /// Linear RGB.
    pub color: [f32; 3],
    /// Weight of the Blinn-Phong highlight, linear.
    pub specular_strength: f32,
    /// Exponent of the highlight.
    pub specular_shininess: f32,
    /// A RevmapProjection.
    pub projection: u32,
    /// A RevmapBumpForm.
    pub bump_form: u32,
    /// Not read.
    pub padding: u32,
    /// Depth by which the slopes of height_map are scaled.
    pub bump: f64,
    /// Repetitions of textures around and along the solid.
    pub texture_repeat: [f64; 2],
    /// Extension, bevel and chamfer.
    pub offset: RevmapOffset,
    /// Position of the axis in the box, each in [0, 1]; the middle is (0.5, 0.5).
    pub axis: [f64; 2],
    /// Number of replicas in the box along x, y, z; at least 1 each.
    pub repeat: [u32; 3],
    /// 1 to reflect every second replica along x, y, z, else 0.
    pub mirror: [u32; 3],
    /// A RevmapClip.
    pub clip: u32,
    /// Not read.
    pub padding_2: u32,
    /// Placement of a solid without instances.
    pub placement: RevmapPlacement,
    /// Placements of its copies; read during the call; null if there are none.
    pub instances: *const RevmapPlacement,
    /// Number of copies; 0: one, at placement.
    pub instance_count: usize,
    /// 1: roughness and metalness count. 0: the roughness is the one that fits
    /// specular_shininess, and there is no metal.
    pub has_material: u32,
    /// For REVMAP_ATTACHMENT_MATERIAL: 0 (a mirror) to 1.
    pub roughness: f32,
    /// For REVMAP_ATTACHMENT_MATERIAL: 0 or 1, or between them.
    pub metalness: f32,
    /// Not read.
    pub padding_end: u32,
    /// By how much of themselves textures are moved around the solid, counter-clockwise from above,
    /// and upwards.
    pub texture_offset: [f64; 2],
}

described!(RevmapObjectInfo {
    0 => [
        size, map_rows, profile, name, color_map, height_map, color, specular_strength,
        specular_shininess, projection, bump_form, padding, bump, texture_repeat, offset, axis, repeat,
        mirror, clip, padding_2, placement, instances, instance_count,
    ]
    1 => [has_material, roughness, metalness, padding_end]
    4 => [texture_offset]
});

impl RevmapObjectInfo {
    pub(crate) unsafe fn object(&self) -> Outcome<Object> {
        let profile = RevmapProfile::get(self.profile)?;
        let name = optional_text(self.name, "name")?.unwrap_or("object");
        let instances = list(self.instances, self.instance_count, "instances")?;
        let mut object = Object::new(name, profile);
        object.map_rows = self.map_rows;
        object.color = self.color;
        object.specular = Specular {
            strength: self.specular_strength,
            shininess: self.specular_shininess,
        };
        object.material = (self.has_material != 0).then_some(Material {
            roughness: self.roughness,
            metalness: self.metalness,
        });
        object.texturing = Texturing {
            color_map: RevmapColorMap::get_optional(self.color_map)?,
            displacement_map: RevmapHeightMap::get_optional(self.height_map)?,
            bump: self.bump,
            bump_form: enums::bump_form(self.bump_form)?,
            projection: enums::projection(self.projection)?,
            repeat: self.texture_repeat,
            offset: self.texture_offset,
        };
        object.offset = self.offset.into();
        object.axis = self.axis;
        object.repeat = self.repeat;
        object.clip = enums::clip(self.clip)?;
        object.mirror = self.mirror.map(|flag| flag != 0);
        object.placement = self.placement.into();
        object.instances = placements(instances).into();
        Ok(object)
    }
}

pub(crate) fn placements(from: &[RevmapPlacement]) -> Vec<Placement> {
    from.iter().map(|&placement| placement.into()).collect()
}

/// Fills in an object without a profile: light grey, plain, at the origin, one world unit high. The
/// size must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_object_defaults(object: *mut RevmapObjectInfo) -> RevmapResult {
    enter(|| {
        let (specular, texturing) = (Specular::default(), Texturing::default());
        let plain = Offset::default();
        let value = RevmapObjectInfo {
            map_rows: Object::MAP_ROWS,
            color: Object::COLOR,
            specular_strength: specular.strength,
            specular_shininess: specular.shininess,
            bump: texturing.bump,
            texture_repeat: texturing.repeat,
            offset: RevmapOffset {
                extend: plain.extend,
                bevel: plain.bevel,
                chamfer: plain.chamfer,
            },
            axis: [0.5; 2],
            repeat: [1; 3],
            placement: UPRIGHT,
            ..sized()
        };
        fill(object, value)
    })
}
