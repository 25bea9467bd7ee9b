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

const StudyTable<Task>& task_table();
const StudyTable<OperatorModel>& operator_table();

}  // namespace catena::study
