// A sequence as one block of bytes, for the viewer's page (web/src/explain/sequence.ts reads it). Little endian, every
// element four bytes:
//   head    counts of the lists below, in their order: solids, steps, marks, points, indices; then bytes of text
//   solids  first point, points, first index, indices, 1: curved
//   steps   title and note: first byte, bytes; first mark, marks
//   marks   kind, ink, solid or -1, 1: faint, first point, points; label: first byte, bytes; width, opacity as floats
//   points  three floats, m, in the frame of A
//   indices three for each triangle, into the points of the solid
//   text    UTF-8, padded to four bytes
#pragma once

#include <string>

#include "explain/sequence.h"

namespace lendulet::explain {

std::string flat(const Sequence& sequence);

}  // namespace lendulet::explain
