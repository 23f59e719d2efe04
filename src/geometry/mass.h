// Mass properties beyond those of single shapes: moving, joining and diagonalising them.
#pragma once

#include <span>

#include "geometry/geometry.h"
#include "lendulet/math.h"
#include "lendulet/shapes.h"

namespace lendulet {

// As the public function of this name.
MassProperties mass_properties(const Geometry& geometry, float density);

// The same solid after `placement`, seen from the frame that leads to: centre moved, inertia turned.
MassProperties placed(const MassProperties& solid, const Transform& placement);

// Several solids as one, all given in the same frame: masses added, inertias moved to the common centre of mass by the
// parallel axis theorem. No mass at all gives an empty result.
MassProperties combined(std::span<const MassProperties> parts);

// The same distribution of mass, denser or lighter, with a total of `mass` (kg).
MassProperties with_mass(const MassProperties& solid, float mass);

// A symmetric tensor as R diag(inertia) R^T, where R is the matrix of `rotation` and leads from principal axes to local
// ones. Tensors that are diagonal within rounding give the identity; otherwise axes are turned as little as the sweep
// of Jacobi rotations leads to, and are not sorted.
struct PrincipalInertia {
    Vec3 inertia;
    Quat rotation;
};
PrincipalInertia principal_axes(const SymMat3& tensor);

}  // namespace lendulet
