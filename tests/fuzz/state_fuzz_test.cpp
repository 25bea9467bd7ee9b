// SPDX-License-Identifier: MIT
/// A recording that begins mid-run contains the chain's raw state. A forged state with valid hashes is refused before a tick uses it as an
/// index, or is harmless: run these tests under the sanitizers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "haptics/chain/validate_state.h"
#include "haptics/constraints/widget_link.h"
#include "haptics/servo/log/log_replay.h"
#include "tests/fuzz/log_bytes.h"
#include "tests/haptics/constraints/examples.h"
#include "tests/support/recording_fixture.h"

namespace catena::state_fuzz_test {

using namespace haptics;

/// Writes random bytes, or extreme indices and doubles, mostly into the first `max_changes` bytes.
void forge(std::span<std::byte> memory, std::size_t max_changes, test::Random& random) {
  static constexpr std::int64_t kIntegers[] = {-1, 1, 2, 6, 7, 40, 255, 1000, 0x7fffffff, -0x80000000ll, 1ll << 40, -(1ll << 40)};
  static const double kNumbers[] = {
      std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300, 1e300, 0.0, 0.5, 5e-324, -1e18};
  const std::size_t reach = random.below(8) == 0 ? memory.size() : std::min(max_changes, memory.size());
  for (std::size_t i = 0, n = 1 + random.below(5); i < n; ++i) {
    const std::size_t at = random.below(reach - 8) & ~(random.below(3) == 0 ? std::size_t{0} : std::size_t{3});
    switch (random.below(5)) {
      case 0:
        memory[at] ^= static_cast<std::byte>(1u << random.below(8));
        break;
      case 1:
        memory[at] = static_cast<std::byte>(random.below(256));
        break;
      case 2:
        std::memcpy(&memory[at], &kIntegers[random.below(std::size(kIntegers))], 4);
        break;
      case 3:
        std::memcpy(&memory[at], &kIntegers[random.below(std::size(kIntegers))], 8);
        break;
      default:
        std::memcpy(&memory[at & ~std::size_t{7}], &kNumbers[random.below(std::size(kNumbers))], 8);
    }
  }
}

/// Number of bytes up to the last non-zero one, which the constraint uses.
std::size_t used(std::span<const std::byte> memory) {
  std::size_t n = memory.size();
  while (n > 16 && memory[n - 1] == std::byte{0}) --n;
  return n;
}

TEST(StateFuzz, AStateThatAConstraintAcceptsIsSafeToRun) {
  haptics::tests::Random places(7);
  const auto table = haptics::tests::all_examples();
  std::uint64_t refused = 0, ran = 0;
  std::map<std::string, int> refused_of;
  for (const haptics::tests::Example& example : table) {
    const auto constraint =
        haptics::tests::build(R"({"name": "a", "type": ")" + example.type + "\", " + example.body + "}", haptics::tests::fields());
    ASSERT_NE(constraint, nullptr);
    haptics::tests::Rig rig(constraint);
    test::FuzzInputs inputs(1 + 20000 / table.size(), 5);  // inputs per constraint
    test::Random& random = inputs.random;
    while (inputs.next()) {
      for (int k = 0; k < 4 && inputs.count() % 8 == 1; ++k) rig.tick(places.box(1.2));
      ASSERT_TRUE(constraint->is_sane(rig.state)) << "as a tick left it";
      haptics::tests::Rig forged(constraint);
      forged.state = rig.state;
      forge(forged.state.memory, used(rig.state.memory), random);
      if (random.below(4) == 0) forge(forged.state.wrapper_memory, 32, random);
      if (random.below(8) == 0) forged.state.proxy = Vec3(std::numeric_limits<double>::quiet_NaN());
      if (!constraint->is_sane(forged.state)) {
        ++refused;
        ++refused_of[example.type];
        continue;
      }
      ++ran;
      Primitive primitive;
      for (int k = 0; k < 3; ++k) {
        forged.tick(places.box(k == 2 ? 3 : 1));
        constraint->primitive(places.box(1), forged.state, forged.scratch, primitive);
      }
      forged.state.evaluations = 0;
      constraint->seek(places.box(1), forged.state, forged.scratch);
    }
  }
  EXPECT_GT(refused, (refused + ran) / 50);
  EXPECT_GT(ran, (refused + ran) / 4);
  for (const char* type : {"polyline", "box", "isosurface", "mesh", "streamline", "drag", "friction", "sphere", "vortex_core"})
    EXPECT_GT(refused_of[type], 0) << type;
  fmt::print("{} forged memories: {} refused, {} run\n", ran + refused, refused, ran);
}

/// Links whose memory contains indices, widgets, a mode, a link with alignment.
std::shared_ptr<HapticProgram> program_of_indices(std::uint64_t epoch) {
  auto program = std::make_shared<HapticProgram>();
  program->epoch = epoch;
  const char* const kLinks[] = {R"({"name": "a", "type": "polyline", "points": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.5]]})",
                                R"({"name": "b", "type": "mesh", "mesh": "box", "free": "above"})",
                                R"({"name": "c", "type": "isosurface", "field": "sphere_grid", "level": 1, "snap": 0.1, "release": 0.3})",
                                R"({"name": "d", "type": "streamline", "field": "circle", "seed": [0.5, 0, 0]})"};
  for (const char* text : kLinks) {
    Link link;
    link.constraint = haptics::tests::build(text, haptics::tests::fields());
    link.name = std::string(1, static_cast<char>('a' + program->links.size()));
    link.spec_hash = program->links.size() + 1;
    link.align.enabled = program->links.empty();
    program->links.push_back(std::move(link));
  }
  program->modes.push_back({"turned", {3, 0}, {}});
  program->modes.back().active_when.button = 2;
  for (const auto& [kind, name] : {std::pair{widget::Kind::box, "crop"}, std::pair{widget::Kind::cutting_plane, "cut"}}) {
    widget::Spec spec;
    spec.kind = kind;
    spec.pose.points = {Vec3(-0.5), Vec3(0.5)};
    program->widgets.push_back(spec);
    program->widget_names.push_back(name);
  }
  add_widget_links(*program);
  program->coupling.ramp_s = 0.02;
  return program;
}

/// A recording of ticks 301 to 340 with the state before them, and another program from tick 321 on.
std::string log_from_the_middle(const std::vector<test::ProgramChange>& changes) {
  const test::TemporaryFolder folder;
  auto state = std::make_unique<ChainState>();
  auto scratch = std::make_unique<ChainScratch>();
  HapticState out;
  const auto path = test::adversarial_path(340);
  for (std::size_t k = 0; k < 300; ++k) tick(*changes[0].program, path[k], *state, *scratch, out);

  log::LogHeader header{"scene.json", "/somewhere", "{\"chain\": []}", {}, "null", "0.1.0", 1000, 1};
  auto writer = log::LogWriter::open(folder / "middle.catlog", header, {}, {});
  (*writer)->begin(*state);
  for (const test::ProgramChange& change : changes) (*writer)->add_program(*change.program, change.scene_text);
  *scratch = ChainScratch{};
  const HapticProgram* program = changes[0].program.get();
  for (std::size_t k = 300; k < path.size(); ++k) {
    if (k == 320) {
      rebind_program(*program, *changes[1].program, *state, *scratch);
      program = changes[1].program.get();
    }
    tick(*program, path[k], *state, *scratch, out);
    (*writer)->put(path[k], out);
  }
  EXPECT_TRUE((*writer)->finish());
  writer->reset();
  return test::read_file(folder / "middle.catlog");
}

/// Begin and end of the payload of the first block of a type.
std::pair<std::size_t, std::size_t> block_of(const std::string& bytes, log::BlockType type) {
  for (std::size_t at = log::kPreambleBytes; at < bytes.size();) {
    log::BlockHeader head;
    std::memcpy(&head, bytes.data() + at, sizeof head);
    at += sizeof head;
    if (head.type == static_cast<std::uint32_t>(type)) return {at, at + head.length};
    at += head.length;
  }
  ADD_FAILURE() << "no such block";
  return {};
}

Result<log::LogReplay> replay(const std::string& bytes, const std::vector<test::ProgramChange>& changes) {
  auto reader = log::LogReader::open(log::make_memory_source(bytes), "x.catlog");
  if (!reader) return reader.error();
  return log::replay_log(*reader, test::make_replay_hooks(changes));
}

struct MiddleLog {
  std::vector<test::ProgramChange> changes{{1, program_of_indices(1), {}}, {321, program_of_indices(2), "{}"}};
  std::string bytes = log_from_the_middle(changes);
  std::size_t state = block_of(bytes, log::BlockType::state).first + 16;  // after tick and layout

  std::string forged(std::size_t at, std::int64_t value, std::size_t size) const {
    std::string out = bytes;
    std::memcpy(out.data() + state + at, &value, size);
    test::rewrite_hashes(out);
    return out;
  }
};

TEST(StateFuzz, AnUnmodifiedRecordingReplaysExactly) {
  const MiddleLog log;
  const auto result = replay(log.bytes, log.changes);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->exact()) << result->difference << result->stop_reason;
  EXPECT_EQ(result->stats.ticks, 40u);
}

TEST(StateFuzz, AForgedIndexIsAnErrorInOneLine) {
  const MiddleLog log;
  const auto memory = [](std::size_t link) { return link * sizeof(LinkState) + offsetof(LinkState, memory); };
  const struct {
    const char* part;
    std::size_t at;
    std::int64_t value;
    std::size_t size;
  } kForged[] = {
      {"link \"d\"", memory(3) + 8, 1ll << 40, 8},  // the index of a curve's interval
      {"link \"a\"", memory(0) + offsetof(LinkState, started) - offsetof(LinkState, memory), 2, 1},
      {"chain", offsetof(ChainState, passivity) + offsetof(PassivityState, next_index), 1 << 30, 4},
      {"chain", offsetof(ChainState, order), 100, 1},
      {"chain", offsetof(ChainState, has_probe), 77, 1},
      {"widgets", offsetof(ChainState, widgets) + offsetof(WidgetsState, engaged), 5, 1},
      {"widgets", offsetof(ChainState, widgets) + offsetof(widget::State, handle), 100, 1},
  };
  for (const auto& forged : kForged) {
    const auto result = replay(log.forged(forged.at, forged.value, forged.size), log.changes);
    ASSERT_FALSE(result) << forged.part << " at " << forged.at;
    test::expect_error_line(result.error().message, "before tick 301: the state of ", {}, std::string::npos, forged.part);
  }
}

// the file says which links keep their state: a state for another constraint is checked by that constraint
TEST(StateFuzz, AStateForAnotherConstraintIsChecked) {
  const MiddleLog log;
  auto other = std::make_shared<HapticProgram>(*log.changes[1].program);
  std::swap(other->links[0].constraint, other->links[3].constraint);
  const std::vector<test::ProgramChange> changes{log.changes[0], {321, other, "{}"}};
  // an arc length is reinterpreted as a search's stack and depth
  const std::string bytes = log.forged(3 * sizeof(LinkState) + offsetof(LinkState, memory) + 200, -1, 8);
  const auto result = replay(bytes, changes);
  ASSERT_FALSE(result);
  EXPECT_TRUE(result.error().message.starts_with("before tick 321: the state of link \"")) << result.error().message;
}

TEST(StateFuzz, ForgedStatesAndProgramsWithGoodHashes) {
  const MiddleLog log;
  test::FuzzInputs inputs(4000, 9);
  test::Random& random = inputs.random;
  const auto state = block_of(log.bytes, log::BlockType::state), program = block_of(log.bytes, log::BlockType::program);
  std::uint64_t refused = 0, ran = 0;
  while (inputs.next()) {
    std::string bytes = log.bytes;
    if (random.below(4) != 0) {
      // a link, a widget or the rest, with equal probability
      const std::size_t link = sizeof(LinkState), links = kMaxLinks, part = random.below(links + 8);
      const std::size_t from = log.state + std::min(part, links) * link, behind = part < links ? from + link : state.second;
      forge(std::as_writable_bytes(std::span(bytes.data() + from, behind - from)), behind - from, random);
    }
    if (random.below(3) == 0) bytes = test::mutate_in_place(bytes, random, program.first, program.second);
    test::rewrite_hashes(bytes);
    const auto result = replay(bytes, log.changes);
    ++(result ? ran : refused);
    ASSERT_TRUE(result || result.error().message.find('\n') == std::string::npos) << result.error().message;
  }
  EXPECT_GT(refused, inputs.count() / 20);
  EXPECT_GT(ran, inputs.count() / 20);
  fmt::print("{} forged recordings: {} refused, {} run\n", inputs.count(), refused, ran);
}

}  // namespace catena::state_fuzz_test
