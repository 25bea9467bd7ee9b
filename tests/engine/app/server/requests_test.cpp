// SPDX-License-Identifier: MIT
#include "engine/app/server/requests.h"

#include <gtest/gtest.h>

#include <random>

namespace requests_test {

using namespace catena::app;

TEST(ClientRequests, ValidRequestsAreParsed) {
  const auto move = parse_request(R"({"do": "move", "number": 7, "pieces": [[1, 2, 3, -4, 0.5, 9]]})");
  ASSERT_TRUE(move);
  const auto& pieces = std::get<MoveRequest>(*move);
  EXPECT_EQ(pieces.number, 7u);
  ASSERT_EQ(pieces.inputs.size(), 1u);
  EXPECT_EQ(pieces.inputs[0].dy, -4);
  EXPECT_TRUE(pieces.inputs[0].left && pieces.inputs[0].shift && !pieces.inputs[0].middle && !pieces.inputs[0].control);
  EXPECT_EQ(std::get<SizeRequest>(*parse_request(R"({"do": "size", "width": 640, "height": 480})")).height, 480u);
  EXPECT_EQ(std::get<Action>(*parse_request(R"({"do": "fit"})")), Action::fit_view);
  EXPECT_EQ(std::get<LevelRequest>(*parse_request(R"({"do": "level", "item": "isosurfaces[0]", "value": 2})")).value, 2);
  const auto opacity = parse_request(R"({"do": "opacity", "item": "volumes[0]", "points": [[0, 0], [1, 5]]})");
  ASSERT_TRUE(opacity);
  EXPECT_LT(std::get<OpacityRequest>(*opacity).points[1].alpha, 1);
  EXPECT_EQ(std::get<ControlRequest>(*parse_request(R"({"do": "take_control"})")), ControlRequest::take);
  EXPECT_EQ(std::get<Action>(*parse_request(R"({"do": "undo"})")), Action::undo);
  EXPECT_EQ(std::get<StepRequest>(*parse_request(R"({"do": "step", "value": 3})")).step, 3);
  EXPECT_TRUE(std::get<RecordRequest>(*parse_request(R"({"do": "record"})")).on);
  EXPECT_FALSE(std::get<RecordRequest>(*parse_request(R"({"do": "stop_recording"})")).on);
  EXPECT_EQ(std::get<TuningRequest>(*parse_request(R"({"do": "tune", "position": 0.25})")).position, 0.25);
  EXPECT_FALSE(std::get<TuningRequest>(*parse_request(R"({"do": "tune"})")).position);
}

TEST(ClientRequests, InvalidRequestsAreRefused) {
  const auto refused = [](const std::string& request) { EXPECT_FALSE(parse_request(request)) << request; };
  for (const char* bad :
       {"", "{}", "[]", "null", "1", R"({"do": 1})", R"({"do": "quit"})", R"({"do": "save"})", R"({"do": "open", "path": "/etc/passwd"})",
        R"({"do": "move"})", R"({"do": "step"})", R"({"do": "record", "do": "x"})", R"({"do": "map", "item": "volumes[0]"})"})
    refused(bad);
  for (const char* bad :
       {R"("pieces": [])", R"("pieces": [[1, 2, 3]])", R"("pieces": [[1e300, 0, 0, 0, 0, 0]])", R"("pieces": [[0, 0, 0, 0, 0, 64]])",
        R"("pieces": [[0, 0, 0, 0, 0, 0.5]])", R"("number": -1, "pieces": [[0, 0, 0, 0, 0, 0]])", R"("pieces": [[0, 0, 0, 0, 0, 1e18]])"})
    refused(R"({"do": "move", )" + std::string(bad) + "}");
  for (const char* bad : {R"("width": 0, "height": 5)", R"("width": 100000, "height": 100)", R"("width": 100)"})
    refused(R"({"do": "size", )" + std::string(bad) + "}");
  for (const char* bad : {R"("item": "x")", R"("item": 3, "value": 1)", R"("item": "x", "value": 1e999)"})
    refused(R"({"do": "level", )" + std::string(bad) + "}");
  refused(R"({"do": "opacity", "item": "volumes[0]", "points": {}})");
  for (const char* bad : {"-1", "0.5", "1e12"}) refused(R"({"do": "step", "value": )" + std::string(bad) + "}");
  for (const char* bad : {"1.5", "\"fast\""}) refused(R"({"do": "tune", "position": )" + std::string(bad) + "}");
  std::string pieces;
  for (std::size_t i = 0; i <= kMaxInputs; ++i) pieces += (i > 0 ? "," : "") + std::string("[0,0,0,0,0,0]");
  EXPECT_FALSE(parse_request(R"({"do": "move", "pieces": [)" + pieces + "]}"));
}

TEST(ClientRequests, RandomChangesAreRefusedInOneLine) {
  const std::string good = R"({"do": "opacity", "item": "volumes[0]", "points": [[0, 0], [0.5, 0.25], [1, 1]]})";
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = good;
    for (unsigned k = random() % 4 + 1; k > 0; --k) text[random() % text.size()] = static_cast<char>(random() % 256);
    const auto request = parse_request(text);
    if (request) continue;
    ++refused;
    EXPECT_EQ(request.error().message.find('\n'), std::string::npos);
  }
  EXPECT_GT(refused, 1500);
}

}  // namespace requests_test
