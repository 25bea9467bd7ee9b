/// The search behind choose_quality (quality.h has the model): settings for a stated error or time, judged on a lattice that has begun.
/// Frame thread.
#pragma once
#include "render/quality/lattice.h"
#include "render/quality/quality.h"

namespace catena::render {

Result<QualityChoice> settings_for_error(Lattice& lattice, double e, const SearchProgress& progress);
Result<QualityChoice> settings_for_time(Lattice& lattice, double ms, const SearchProgress& progress, const DrawTimer& timer);

}  // namespace catena::render
