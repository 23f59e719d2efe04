// Which contacts may meet in a substep, of those that impacts look after: told for many at a time, since few do.
#pragma once

#include <cstdint>

#include "lendulet/math.h"
#include "solver/contact.h"

namespace lendulet {

// A contact that can bounce or is swift, with what it takes to pass it over without reading its record.
struct ImpactContact {
    uint32_t record;
    int32_t a, b;  // solver bodies
    bool passes;   // nothing comes of it while both move as the step began, see contact_passes
    bool held;     // all of its points carried something when the step began: these meet nothing before a blow comes
    bool crowded;  // one of a crowd, in which blows go on by rows
    int32_t next = -1;  // in the list: the next between the same bodies, where all that is fixed is one; or -1
};

// Those that a block is filled in with: [first, first + meeting_lanes) of a list. Impacts look after points that
// carried nothing, and not after those too slow to bounce.
enum class MeetingsOf : uint8_t { impacts, all_points };
struct MeetingContacts {
    const ImpactContact* list;
    int first, count;  // and how many there are in all
    MeetingsOf of;
};

// Sixteen of them as the kernels see them, component by component; filled in when the step begins.
inline constexpr int meeting_lanes = 16;
struct alignas(64) MeetingBlock {
    using Lanes = float[meeting_lanes];
    int32_t a[meeting_lanes], b[meeting_lanes];
    Lanes normal[3];      // or the way between the centres of two balls, m
    Lanes radii;          // of two balls, m; 0: others
    Lanes face;           // 1 where the normal turns with A, -1 with B, else 0
    Lanes separation[4];  // at the start of the step, m; far where a point is missing or carried something
    // The points that turn with the bodies, from the centres of mass at the start of the step, m.
    Lanes core_a[4][3], core_b[4][3];
    Lanes pull;            // the bodies' accelerations, m/s^2
    Lanes pull_a, pull_b;  // and by how much turning accelerates the points: times the square of w, m
    Lanes slowest;         // bounces are at least so many times SubstepConstants::bounce_speed fast
    int32_t points;        // most of any of them
    uint32_t meets;        // those that may meet in this substep, by lane
    bool ready;            // filled in
};

// Points closer than this count as touching already: positions a metre from the body's centre resolve 1e-7 m.
inline constexpr float touching_gap = 1e-6f;
// What rounding may add to a distance, in parts of those that it is the sum of.
inline constexpr float rounding_share = 1e-5f;

// The normal of a face that a corner meets turns with its body, see turn_row().
LENDULET_FORCE_INLINE bool turns_with_face(const ContactRecord& r) {
    return (r.flags & contact_sharp) != 0 && r.follow != 0.5f;
}

// The slowest impact of a contact that bounces, in parts of SubstepConstants::bounce_speed: one after which the bodies
// part with that speed. Of contacts that are swift whatever their restitution all that are as fast as that before.
LENDULET_FORCE_INLINE float slowest_bounce(const ContactRecord& r) {
    return (r.flags & contact_swift) != 0 ? 1.0f : 1.0f / maximum(r.restitution, 1e-3f);
}

}  // namespace lendulet
