// SPDX-License-Identifier: MIT
#include "engine/field/derived/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <limits>

#include "engine/base/text.h"

namespace catena::field {
namespace {

constexpr std::size_t kMaxText = 4000;  // muParser's own limit is 10000
constexpr int kMaxDepth = 100;          // nested parentheses

/// Position and depth of the first thing that muParser accepts although it is no expression of a value: an assignment, or a list.
ExpressionFault find_unwanted(const std::string& text) {
  int depth = 0, deepest = 0;
  std::vector<bool> is_call;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i], before = i > 0 ? text[i - 1] : ' ', after = i + 1 < text.size() ? text[i + 1] : ' ';
    if (c == '(') {
      std::size_t k = i;
      while (k > 0 && text[k - 1] == ' ') --k;
      is_call.push_back(k > 0 && (std::isalnum(static_cast<unsigned char>(text[k - 1])) || text[k - 1] == '_'));
      deepest = std::max(deepest, ++depth);
    }
    if (c == ')' && depth > 0) {
      --depth;
      is_call.pop_back();
    }
    if (c == ',' && (is_call.empty() || !is_call.back())) return {"a list of values; one expression was expected", int(i) + 1};
    const bool compares = after == '=' || before == '=' || before == '<' || before == '>' || before == '!';
    if (c == '=' && !compares) return {"an assignment; an expression was expected", int(i) + 1};
    if (c == '"') return {"a text; numbers and variables were expected", int(i) + 1};
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~')
      return {"a character that is no letter, digit or operator", int(i) + 1};
    if (deepest > kMaxDepth) return {fmt::format("more than {} nested parentheses", kMaxDepth), int(i) + 1};
  }
  return {};
}

}  // namespace

struct Expressions::Parsers {
  std::vector<double> values;  // of the variables; then x, y, z, t
  std::vector<mu::Parser> list;
};

Expressions::Expressions(const std::vector<std::string>& texts, const std::vector<NodeVariable>& variables, double time)
    : parsers_(std::make_unique<Parsers>()) {
  parsers_->values.assign(variables.size() + 4, 0);
  parsers_->values.back() = time;
  parsers_->list.resize(texts.size());
  for (std::size_t k = 0; k < texts.size(); ++k) {
    mu::Parser& parser = parsers_->list[k];
    double* value = parsers_->values.data();
    for (const NodeVariable& variable : variables) parser.DefineVar(variable.name, value++);
    for (const char* word : {"x", "y", "z", "t"}) parser.DefineVar(word, value++);
    parser.SetExpr(texts[k]);
  }
}

Expressions::~Expressions() = default;

void Expressions::set(std::size_t i, double value) { parsers_->values[i] = value; }

void Expressions::set_time(double time) { parsers_->values.back() = time; }

void Expressions::evaluate(const Vec3& world, Vec3& result) {
  double* position = parsers_->values.data() + parsers_->values.size() - 4;
  for (int a = 0; a < 3; ++a) position[a] = world[a];
  for (std::size_t k = 0; k < parsers_->list.size(); ++k) {
    try {
      result[int(k)] = parsers_->list[k].Eval();
    } catch (const mu::Parser::exception_type&) {
      result[int(k)] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

ExpressionFault check_expression(const std::string& expression, const std::vector<std::string>& variables) {
  if (expression.size() > kMaxText) return {fmt::format("it has {} characters; at most {} were expected", expression.size(), kMaxText), 1};
  if (ExpressionFault unwanted = find_unwanted(expression); !unwanted.message.empty()) return unwanted;
  std::vector<NodeVariable> all;
  for (const std::string& name : variables) all.push_back({name, {}, 0});
  try {
    mu::Parser parser;
    std::vector<double> values(variables.size() + 4, 1.0);
    double* value = values.data();
    for (const std::string& name : variables) parser.DefineVar(name, value++);
    for (const char* word : {"x", "y", "z", "t"}) parser.DefineVar(word, value++);
    parser.SetExpr(expression);
    int results = 0;
    parser.Eval(results);
    if (results != 1) return {"a list of values; one expression was expected", 1};
  } catch (const mu::Parser::exception_type& fault) {
    const int column = std::clamp(fault.GetPos() + 1, 1, int(expression.size()) + 1);
    if (fault.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
      std::vector<std::string_view> words{"x", "y", "z", "t"};
      words.insert(words.end(), variables.begin(), variables.end());
      return {fmt::format("{} is not known; one of {} or a function was expected{}", in_quotes(fault.GetToken()), join_words(words),
                          suggestion(fault.GetToken(), words)),
              column};
    }
    if (fault.GetCode() == mu::ecEMPTY_EXPRESSION) return {"it is empty", 1};
    std::string message = fault.GetMsg();
    message.resize(std::min(message.size(), message.rfind(" at position ")));  // the column states it
    while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
    return {message, column};
  }
  return {};
}

}  // namespace catena::field
