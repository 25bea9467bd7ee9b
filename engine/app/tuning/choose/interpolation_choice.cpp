// SPDX-License-Identifier: MIT
#include "engine/app/tuning/choose/interpolation_choice.h"

#include "engine/base/json_edit.h"
#include "engine/field/grid/grid.h"

namespace catena::app::tuning {

bool is_interpolation_unset(const scene::FieldSource& source) {
  return source.file && source.file->interpolation == field::Interpolation::linear && source.series.empty() && !source.has_changed_step &&
         source.where.find(kInterpolationKey) == nullptr;
}

Outcome set_cubic_interpolation(scene::FieldSource& source) {
  field::AnyField& loaded = source.loaded;
  if (loaded.scalar && loaded.scalar->grid()) {
    CATENA_TRY(loaded.scalar, loaded.scalar->grid()->as_cubic());
  } else if (loaded.vector && loaded.vector->grid()) {
    CATENA_TRY(loaded.vector, loaded.vector->grid()->as_cubic());
  }
  source.file->interpolation = field::Interpolation::cubic;
  source.rendered = {};
  return Done{};
}

std::string field_pointer(const std::string& name) { return "/fields/" + json::escape_pointer_token(name); }

}  // namespace catena::app::tuning
