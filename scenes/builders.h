// The functions behind the built-in scenes' names, one per scene; registry.cpp lists them with their sizes. Scenes are
// y-up, in metres and kilograms.
#pragma once

#include "scenes/description.h"

namespace lendulet::scenes {

// piles.cpp: bodies of one kind or of several, turned at random, dropped into an open container
SceneDescription box_pile(int count);
SceneDescription sphere_pile(int count);
SceneDescription capsule_pile(int count);
SceneDescription convex_pile(int count);
SceneDescription mixed_pile(int count);
SceneDescription mesh_terrain(int count);
SceneDescription height_field(int count);

// stacks.cpp: ordered heaps that should stand
SceneDescription large_pyramid(int base);
SceneDescription many_pyramids(int side);
SceneDescription stack(int height);
SceneDescription mass_ratio(int ratio);
SceneDescription wall_ball(int rows);
SceneDescription dominoes(int count);

// joints.cpp
SceneDescription joint_grid(int side);
SceneDescription chain_heavy(int ratio);
SceneDescription newtons_cradle(int balls);

// ragdolls.cpp
SceneDescription ragdolls(int count);

SceneDescription ragdoll_avalanche(int count);

// gallery/structures.cpp, vehicles.cpp, machines.cpp, walker.cpp, flow.cpp, spin.cpp
SceneDescription domino_spiral(int count);
SceneDescription brick_tower(int courses);
SceneDescription arch(int stones);
SceneDescription card_house(int storeys);
SceneDescription bridge(int planks);
SceneDescription car(int);
SceneDescription gear_train(int gears);
SceneDescription walker(int);
SceneDescription hourglass(int grains);
SceneDescription marble_machine(int marbles);
SceneDescription t_handle(int);
SceneDescription ten_thousand_boxes(int);

// motion.cpp: kinematic motion, sleep, free rotation
SceneDescription tumbler(int side);
SceneDescription large_world_sleep(int count);
SceneDescription dzhanibekov(int);

// thesis.cpp: the demos of the founding thesis
SceneDescription many_things(int side);
SceneDescription two_spheres(int);
SceneDescription sphere_and_box(int);
SceneDescription two_boxes(int);
SceneDescription wrecking_ball(int side);
SceneDescription carpet_bomb(int side);
SceneDescription spinning_ball(int side);
SceneDescription rotating_board(int side);

}  // namespace lendulet::scenes
