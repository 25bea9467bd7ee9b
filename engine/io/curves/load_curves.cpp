// SPDX-License-Identifier: MIT
#include "engine/io/curves/load_curves.h"

#include "engine/base/text.h"
#include "engine/io/formats.h"

namespace catena::curves {

Result<CurveSetPtr> load_curves(const std::string& path, int step) {
  const io::Format* format = io::find_reader(path, io::DataKind::curves);
  if (format == nullptr)
    return Error{one_line(path + ": has an unknown file type; " + io::describe_expected(io::DataKind::curves) + " was expected")};
  CATENA_TRY(CurveSet set, format->read_curves(path, step));
  return CurveSetPtr(std::make_shared<CurveSet>(std::move(set)));
}

}  // namespace catena::curves
