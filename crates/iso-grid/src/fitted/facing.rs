//! Which way a surface faces, so that a camera does not look at its edge.

use glam::{DMat3, DVec3};

/// How a surface lies, as far as it is found: the means of all products of two components of its unit normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing(DMat3);

impl Facing {
    /// Of a surface with these normals, of any length; `None` when there are none.
    pub(super) fn of(normals: &[DVec3]) -> Option<Self> {
        let units = normals.iter().filter_map(|normal| normal.try_normalize());
        let products = units.map(|unit| DMat3::from_cols(unit.x * unit, unit.y * unit, unit.z * unit));
        let (sum, count) =
            products.fold((DMat3::ZERO, 0), |(sum, count), product| (sum + product, count + 1));
        (count > 0).then(|| Self(sum * (1.0 / f64::from(count))))
    }

    /// How much of it faces `direction`, a unit vector, or turns its back to it: the mean square of the cosines between them. That is 1 where a
    /// plane is seen from the front, a third for a sphere, and 0 where only an edge would be seen.
    pub fn towards(&self, direction: DVec3) -> f64 {
        direction.dot(self.0 * direction)
    }

    /// That of both surfaces.
    pub(super) fn hull(&self, other: &Self) -> Self {
        Self((self.0 + other.0) * 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fitted;
    use crate::fitted::tests::around;

    #[test]
    fn surfaces_face_where_their_normals_point() {
        let plane = around("x + 2y + 3z = 6").facing.unwrap();
        let normal = DVec3::new(1.0, 2.0, 3.0).normalize();
        assert!((plane.towards(-normal) - 1.0).abs() < 1e-9);
        assert!(plane.towards(normal.any_orthonormal_vector()).abs() < 1e-9);
        // Cells are longer along one axis than along others.
        let slab = around("max(abs(x) - 3, abs(y) - 0.2, abs(z) - 2) = 0").facing.unwrap();
        assert!(slab.towards(DVec3::Y) > slab.towards(DVec3::X) + slab.towards(DVec3::Z));
        let cylinder = around("x^2 + y^2 = 1").facing.unwrap();
        assert!(cylinder.towards(DVec3::Z) < 1e-9 && (cylinder.towards(DVec3::X) - 0.5).abs() < 0.05);
    }

    #[test]
    fn balls_face_all_ways_alike() {
        let ball = around("x^2 + y^2 + z^2 = 1").facing.unwrap();
        for direction in DVec3::AXES {
            assert!((ball.towards(direction) - 1.0 / 3.0).abs() < 0.05, "{ball:?}");
        }
    }

    #[test]
    fn what_is_found_nowhere_faces_no_way() {
        assert_eq!(around("x^2 + y^2 + z^2 = -1").facing, None);
        let [ball, plane] = ["x^2 + y^2 + z^2 = 1", "z = 0.1"].map(around);
        let both = ball.hull(&plane).unwrap().facing.unwrap();
        assert!((both.towards(DVec3::Z) - 2.0 / 3.0).abs() < 0.05, "{both:?}");
        let nothing = Fitted { facing: None, sphere: None, ..ball };
        assert_eq!(ball.hull(&nothing).unwrap().facing, ball.facing);
    }
}
