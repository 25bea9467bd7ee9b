/// --colormap NAME and --range LO HI: how a bare data file is coloured.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/components.h"

namespace CLI {
class App;
}

namespace catena::app {

struct ColorOption {
  std::string map;
  std::vector<std::string> range;

  void add_to(CLI::App& command);
  Result<scene::NamedColors> named() const;
};

}  // namespace catena::app
