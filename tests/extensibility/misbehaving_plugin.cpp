// SPDX-License-Identifier: MIT
// A plug-in with the error that CATENA_TEST_WRONG selects.
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "haptics/plugin/plugin.h"

namespace {

using namespace catena;
using namespace catena::haptics;

std::string wrong() {
  const char* const value = std::getenv("CATENA_TEST_WRONG");
  return value == nullptr ? "" : value;
}

/// Runs before main.
struct Early {
  Early() {
    if (wrong() == "throws early") throw std::runtime_error("no such luck");
    if (wrong() == "crashes early") std::abort();
  }
};
const Early early;

Result<std::shared_ptr<const Constraint>> build_strange(const json::Node&, const BuildContext&) {
  if (wrong() == "build throws") throw std::runtime_error("no such luck");
  return std::shared_ptr<const Constraint>();
}

ConstraintType strange() {
  if (wrong() == "throws") throw std::runtime_error("no such luck");
  if (wrong() == "throws a number") throw 7;
  ConstraintType type{"strange", "Is strange.", "", {}, build_strange};
  if (wrong() == "no word") type.type = "";
  if (wrong() == "no name") type.type = "Two Words";
  if (wrong() == "catena's") type.type = "plane";
  if (wrong() == "a mode's") type.type = "anisotropic_friction";
  if (wrong() == "shell's") type.type = "shell";
  if (wrong() == "no build") type.build = nullptr;
  if (wrong() == "a key of every link") type.keys = {schema::number("snap", "world", "Twice.")};
  return type;
}

ConstraintType second() { return {wrong() == "twice" ? "strange" : "stranger", "Is strange.", "", {}, build_strange}; }

}  // namespace

CATENA_CONSTRAINT_PLUGIN(strange, second)
