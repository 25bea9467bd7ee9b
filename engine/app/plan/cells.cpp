#include "engine/app/plan/cells.h"

#include "engine/base/json_edit.h"
#include "engine/field/grid.h"

namespace catena::app::plan {

bool leaves_cells_open(const scene::FieldSource& source) {
  return source.file && source.file->interpolation == field::Interpolation::linear && source.series.empty() && !source.stepped &&
         source.where.find(kCellsKey) == nullptr;
}

Outcome make_cubic(scene::FieldSource& source) {
  field::AnyField& loaded = source.loaded;
  if (loaded.scalar && loaded.scalar->grid()) {
    CATENA_TRY(loaded.scalar, loaded.scalar->grid()->cubic());
  } else if (loaded.vector && loaded.vector->grid()) {
    CATENA_TRY(loaded.vector, loaded.vector->grid()->cubic());
  }
  source.file->interpolation = field::Interpolation::cubic;
  source.drawn = {};
  return Done{};
}

std::string place_of_field(const std::string& name) { return "/fields/" + json::pointer_step(name); }

}  // namespace catena::app::plan
