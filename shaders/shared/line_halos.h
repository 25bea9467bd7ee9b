// SPDX-License-Identifier: MIT
// Halos of lines: data of line_halos.frag.
#ifndef CATENA_SHARED_LINE_HALOS_H
#define CATENA_SHARED_LINE_HALOS_H
#include "shaders/shared/language.h"

#define LINE_ID_WORDS 64

CATENA_SHARED_BEGIN

struct LineHaloData {
  uint is_line[LINE_ID_WORDS];  // one bit per object id
  int reach, directions;        // width of a halo, pixels; 8
  float least_gap, full_gap;    // distance in depth behind a line: where its halo begins, where it is darkest; world units
  float darkness;               // share of the color that the darkest halo takes
};

CATENA_SHARED_END
#endif
