// The module has no code of its own: what it exports is the C interface (see CMakeLists.txt), which must only fit it.
#include "lendulet/lendulet_c.h"

// What the page reads without asking for offsets.
static_assert(sizeof(lendulet_pose) == 32 && sizeof(lendulet_contact) == 48);
static_assert(sizeof(lendulet_collider) == 68 && offsetof(lendulet_collider, size) == 16 &&
              offsetof(lendulet_collider, position) == 36);
static_assert(sizeof(lendulet_hit) == 40 && offsetof(lendulet_hit, point) == 12);
static_assert(sizeof(lendulet_body_state) == 172 && offsetof(lendulet_body_state, mass) == 88 &&
              offsetof(lendulet_body_state, name) == 108);
static_assert(sizeof(lendulet_statistics) == 168 && offsetof(lendulet_statistics, bodies) == 136);
static_assert(sizeof(lendulet_mesh) == 8 + 2 * sizeof(void*));
static_assert(sizeof(lendulet_settings) == 64 && sizeof(lendulet_joint_state) == 120 && sizeof(lendulet_box) == 32 &&
              sizeof(lendulet_group) == 8 && sizeof(lendulet_motion) == 48 && sizeof(lendulet_part) == 76 &&
              sizeof(lendulet_body_definition) == 136 && sizeof(lendulet_joint_definition) == 128);
