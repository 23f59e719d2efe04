// What a step can simulate, and how far ahead it looks.
#pragma once

namespace lendulet {

// Speeds beyond these are cut (and counted): positions in single precision do not resolve such motion.
inline constexpr float max_speed = 1e4f;          // m/s
inline constexpr float max_angular_speed = 3e3f;  // rad/s, about 200 turns per step at 60 Hz
// Surfaces this close are already given contact points, so that resting contacts are not found anew every step.
inline constexpr float contact_margin = 0.02f;  // m; less for small bodies
// Contacts are not sought for the turning of bodies that turn farther than this in a step, rad: continuous collision
// finds where they touch.
inline constexpr float most_foreseen_turn = 1.5f;
// Positions beyond this have a resolution worse than a millimetre-sized contact needs.
inline constexpr float world_extent = 1e7f;  // m

}  // namespace lendulet
