// SPDX-License-Identifier: MIT
/// The study of the paper, and small studies in which a test changes a line.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "engine/study/study.h"
#include "tests/support/support.h"

namespace study_rig {

using namespace catena;

inline const study::Study& paper_study() {
  static const study::Study study = study::read_study(test::source_dir() + "/assets/studies/proxy-chain.json").value();
  return study;
}

/// A study with one task in two conditions; the first occurrence of `from` is replaced by `to`.
inline std::string small_study_text(const std::string& from = {}, const std::string& to = {}) {
  std::string text = R"({
  "name": "small", "trials": 3, "training": 1,
  "tasks": [
    {"name": "trace", "kind": "tracing", "dimensions": 2, "field": "flow",
     "scene": {
       "fields": {"flow": {"analytic": "vortices", "dimensions": 2, "seed": "$seed"}},
       "camera": {"position": [0, 0, 8], "target": [0, 0, 0], "up": [0, 1, 0]},
       "workspace": {"metres_per_unit": 0.05}
     }}],
  "conditions": [
    {"name": "free", "chain": []},
    {"name": "held", "chain": [
       {"name": "line", "type": "streamline", "field": "flow", "seed": "$start"}]}]
})";
  if (!from.empty()) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  return text;
}

inline study::Study small(const std::string& from = {}, const std::string& to = {}) {
  return study::parse_study(small_study_text(from, to), "small.json").value();
}

}  // namespace study_rig
