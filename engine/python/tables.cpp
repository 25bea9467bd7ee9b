// SPDX-License-Identifier: MIT
/// catena.recording and catena.study_table: recorded data as arrays.
#include <map>
#include <string>

#include "engine/python/module.h"
#include "engine/study/trial_table.h"
#include "haptics/servo/log/reader.h"

namespace catena::python {
namespace {

using haptics::log::LogEvent;
using haptics::log::LogReader;

/// The ticks of a recording; all of them have the links of the first program.
struct Recorded {
  std::vector<double> t, period_us, compute_us;
  std::vector<std::uint64_t> tick;
  std::vector<std::uint32_t> buttons;
  std::vector<Vec3> probe, force, proxies;
  std::vector<std::uint8_t> status;
  std::vector<std::string> links, gaps;
  std::string ending, device, version, scene;
};

Recorded read_recording(const std::string& path) {
  LogReader log = unwrap(LogReader::open(path));
  Recorded out;
  bool known = false;
  for (LogEvent event = log.next(); event != LogEvent::done; event = log.next()) {
    if (event == LogEvent::gap) out.gaps.push_back(log.gap().description());
    if (event == LogEvent::program) {
      const std::vector<std::string> links = log.program().link_names();
      if (known && links != out.links)
        throw Failure(Error{path + ": the links of the chain change at tick " + std::to_string(log.program().first_tick) +
                            "; a recording of one chain was expected (catena replay --log writes tables of others)"});
      out.links = links;
      known = true;
    }
    if (event != LogEvent::tick) continue;
    const HapticState& state = log.tick().output;
    out.tick.push_back(state.tick);
    out.t.push_back(state.t_s);
    out.buttons.push_back(state.buttons);
    out.probe.push_back(state.probe);
    out.force.push_back(state.force_n);
    out.period_us.push_back(state.period_us);
    out.compute_us.push_back(state.compute_us);
    for (std::size_t i = 0; i < out.links.size(); ++i) {
      const bool there = i < static_cast<std::size_t>(state.link_count);
      out.proxies.push_back(there ? state.links[i].proxy : Vec3(0.0));
      out.status.push_back(static_cast<std::uint8_t>(there ? state.links[i].status : LinkStatus::free));
    }
  }
  out.ending = log.end_summary();
  out.device = log.header().device;
  out.version = log.header().catena_version;
  out.scene = log.header().scene_text;
  return out;
}

template <class T>
py::array_t<T> column(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::dict recording(const std::string& path) {
  Recorded r;
  {
    const py::gil_scoped_release unlocked;
    r = read_recording(path);
  }
  const auto n = static_cast<py::ssize_t>(r.t.size()), links = static_cast<py::ssize_t>(r.links.size());
  py::dict out;
  out["tick"] = column(r.tick);
  out["t"] = column(r.t);
  out["probe"] = to_array(r.probe);
  out["forces"] = to_array(r.force);
  out["buttons"] = column(r.buttons);
  out["proxies"] = to_array(r.proxies).reshape({n, links, py::ssize_t(3)});
  out["statuses"] = column(r.status).reshape({n, links});
  out["period_us"] = column(r.period_us);
  out["compute_us"] = column(r.compute_us);
  out["links"] = r.links;
  out["gaps"] = r.gaps;
  out["ending"] = r.ending;
  out["device"] = r.device;
  out["version"] = r.version;
  out["scene"] = r.scene;
  return out;
}

template <class Member>
py::list words(const std::vector<study::TrialRow>& rows, Member member) {
  py::list out;
  for (const study::TrialRow& row : rows) out.append(row.*member);
  return out;
}

py::dict study_table(const std::string& folder) {
  const study::TrialTable table = unwrap(study::read_trial_table(folder));
  const std::vector<study::TrialRow>& rows = table.rows;
  const py::object array = py::module_::import("numpy").attr("array");
  py::dict out;
  const auto add = [&](const char* name, const py::list& values, const char* type) { out[name] = array(values, py::arg("dtype") = type); };
  add("subject", words(rows, &study::TrialRow::subject), "int64");
  add("index", words(rows, &study::TrialRow::index), "int64");
  add("block", words(rows, &study::TrialRow::block), "int64");
  add("task", words(rows, &study::TrialRow::task), "str");
  add("kind", words(rows, &study::TrialRow::kind), "str");
  add("dimensions", words(rows, &study::TrialRow::dimensions), "int64");
  add("condition", words(rows, &study::TrialRow::condition), "str");
  add("stimulus", words(rows, &study::TrialRow::stimulus), "int64");
  add("seed", words(rows, &study::TrialRow::seed), "int64");
  add("training", words(rows, &study::TrialRow::training), "bool");
  add("by_target", words(rows, &study::TrialRow::reached_target), "bool");
  add("time_s", words(rows, &study::TrialRow::time_s), "float64");
  add("error_mm", words(rows, &study::TrialRow::error_mm), "float64");
  add("travelled_mm", words(rows, &study::TrialRow::traveled_mm), "float64");
  add("peak_force_n", words(rows, &study::TrialRow::peak_force_n), "float64");
  std::vector<Vec3> ends;
  for (const study::TrialRow& row : rows) ends.push_back(row.end_mm);
  out["end_mm"] = to_array(ends);
  out["simulated"] = study::is_simulated(folder);
  out["notes"] = table.notes;
  return out;
}

}  // namespace

void add_tables(py::module_& m) {
  m.def("_recording", recording, py::arg("path"));
  m.def("_study_table", study_table, py::arg("folder"));
}

}  // namespace catena::python
