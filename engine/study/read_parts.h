/// How the parts of the study file are read, one table each. Inside this room only.
#pragma once
#include "engine/schema/table.h"
#include "engine/study/study.h"

namespace catena::study {

/// What reading needs besides: nothing.
struct None {};
template <class T>
using StudyTable = schema::Table<T, const None>;

inline constexpr None kNone{};

/// A key whose value, an array or an object, another room reads: any_of without choices.
inline schema::Key array_or_object(const std::string& name, const std::string& help) {
  schema::Key key;
  key.name = name;
  key.form = schema::Form::any_of;
  key.help = help;
  return key;
}

const StudyTable<Task>& task_table();
const StudyTable<OperatorModel>& operator_table();

}  // namespace catena::study
