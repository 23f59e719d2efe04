// Everything but the character (character.h): include this.
#pragma once

#include "lendulet/body.h"
#include "lendulet/events.h"
#include "lendulet/joint.h"
#include "lendulet/math.h"
#include "lendulet/options.h"
#include "lendulet/query.h"
#include "lendulet/result.h"
#include "lendulet/shapes.h"
#include "lendulet/world.h"

// The engine's version, by the rules of semver.org; the program and the CMake package have it from here.
#define LENDULET_VERSION_MAJOR 0
#define LENDULET_VERSION_MINOR 1
#define LENDULET_VERSION_PATCH 0
