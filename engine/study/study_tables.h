/// How the parts of the study file are read, one table each. Inside this room only.
#pragma once
#include "engine/schema/struct_schema.h"
#include "engine/study/study.h"

namespace catena::study {

/// What reading needs besides: nothing.
struct NoContext {};
template <class T>
using StudyTable = schema::StructSchema<T, const NoContext>;

inline constexpr NoContext kNoContext{};

/// A key whose value, an array or an object, another room reads: any_of without choices.
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
