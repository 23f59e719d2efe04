// The cases, by theme. The table that names them is in run.cpp.
#pragma once

#include "verify/case.h"

namespace lendulet::verify {

// free_motion.cpp: bodies that touch nothing
void free_fall(const Setting&, Figures&);
void convergence_order(const Setting&, Figures&);
void symmetric_top(const Setting&, Figures&);
void dzhanibekov(const Setting&, Figures&);
// conservation.cpp
void gas_and_burst(const Setting&, Figures&);
// bounces.cpp, many_bounces.cpp, impacts.cpp
void bounce_heights(const Setting&, Figures&);
void bouncing_balls(const Setting&, Figures&);
void elastic_cube_of_balls(const Setting&, Figures&);
void dead_cube_of_balls(const Setting&, Figures&);
void cradle(const Setting&, Figures&);
void oblique_sliding(const Setting&, Figures&);
void oblique_gripping(const Setting&, Figures&);
void superball(const Setting&, Figures&);
// friction.cpp, stick_slip.cpp
void stick_slip_threshold(const Setting&, Figures&);
void sliding_and_stopping(const Setting&, Figures&);
void static_and_kinetic(const Setting&, Figures&);
void isotropy(const Setting&, Figures&);
// rolling.cpp, rolling_carrier.cpp
void slide_to_roll(const Setting&, Figures&);
void rolling_down(const Setting&, Figures&);
void rolling_carrier(const Setting&, Figures&);
// repose.cpp
void angle_of_repose(const Setting&, Figures&);
// statics.cpp, stacks.cpp, recovery.cpp, dominoes.cpp
void tipping(const Setting&, Figures&);
void dominoes(const Setting&, Figures&);
void mass_ratio_stacks(const Setting&, Figures&);
void tall_stacks(const Setting&, Figures&);
void penetration_recovery(const Setting&, Figures&);
// pendulums.cpp, chains.cpp, mechanisms.cpp
void heavy_top(const Setting&, Figures&);
void hanging_chain(const Setting&, Figures&);
void payload_chain(const Setting&, Figures&);
void pendulum(const Setting&, Figures&);
void closed_loops(const Setting&, Figures&);
void spring_mass_damper(const Setting&, Figures&);
// continuous.cpp
void bullets_against_walls(const Setting&, Figures&);
void spinning_rods(const Setting&, Figures&);

}  // namespace lendulet::verify
