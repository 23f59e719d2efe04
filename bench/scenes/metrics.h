// Measures of quality from body poses alone, computed in the same way for every engine and sharing no code with any.
#pragma once

#include <vector>

#include "scenes/description.h"

namespace lendulet::bench {

// Overlap of two solids in metres, negative where they are apart; boxes against round shapes are not measured (-1).
float overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b);

struct Penetration {
    double mean = 0.0, p99 = 0.0, max = 0.0;  // m
    int pairs = 0;                            // that overlap by more than 0.1 mm
};
// Over all pairs of moving boxes, balls and capsules.
Penetration penetration(const scenes::SceneDescription& scene, const std::vector<Pose>& poses);

struct JointError {
    double mean = 0.0, max = 0.0;  // gap between a joint's two anchors, m
};
JointError joint_error(const scenes::SceneDescription& scene, const std::vector<Pose>& poses);

struct Drift {
    double sideways = 0.0;    // largest horizontal way from the start, m
    double last_sinks = 0.0;  // how far the last body (the top of stacks and pyramids) came down, m
    double mean_speed = 0.0;  // m/s, from the last two poses
    int not_finite = 0;
    double lowest_way = 0.0, highest_way = 0.0;  // of all bodies along y, m
};
// False where a body is not finite or has left the scene (100 m below where it began), or where something that is built
// to stand (stacks, pyramids, mass ratios) has a body that is half a metre from its place.
bool stands(const scenes::SceneDescription& scene, const Drift& drift);
Drift drift(const scenes::SceneDescription& scene, const std::vector<Pose>& before_last, const std::vector<Pose>& last);

}  // namespace lendulet::bench
