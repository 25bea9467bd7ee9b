// SPDX-License-Identifier: MIT
/// The key tables that read the parts of the study file. Private to this module.
#pragma once
#include "engine/schema/struct_schema.h"
#include "engine/study/study.h"

namespace catena::study {

/// Empty context: reading a study needs no other object.
struct NoContext {};
template <class T>
using StudyTable = schema::StructSchema<T, const NoContext>;

inline constexpr NoContext kNoContext{};

/// A key whose value, an array or an object, is read by another module: any_of without choices.
inline schema::Key array_or_object(const std::string& name, const std::string& help) {
  schema::Key key;
  key.name = name;
  key.value_type = schema::ValueType::any_of;
  key.help = help;
  return key;
}

const StudyTable<Task>& task_table();
const StudyTable<HumanModelParameters>& human_model_table();

}  // namespace catena::study
