// Everything: include this.
#pragma once

#include "lendulet/body.h"
#include "lendulet/joint.h"
#include "lendulet/math.h"
#include "lendulet/options.h"
#include "lendulet/query.h"
#include "lendulet/result.h"
#include "lendulet/shapes.h"
#include "lendulet/world.h"
