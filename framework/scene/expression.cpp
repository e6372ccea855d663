// SPDX-License-Identifier: BSD-3-Clause
// Formulas by muParser, with our own words for what is wrong in them.
#include "framework/scene/expression.hpp"

#include <fmt/core.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "framework/scene/tree.hpp"

namespace tenon::scene {
namespace {

constexpr std::size_t longest = 4000;

/// Set where bessel_j met an order that is not whole: refused if an expression is written so, not a number where the
/// order varies.
thread_local bool fractional_order = false;

double bessel_j(double order, double x) {
  if (order != std::floor(order)) {
    fractional_order = true;
    return std::numeric_limits<double>::quiet_NaN();
  }
  return ::jn(static_cast<int>(std::clamp(order, -1e6, 1e6)), x);
}
double step(double x) {
  return x < 0 ? 0.0 : 1.0;
}
double sign(double x) {
  return static_cast<double>(x > 0) - static_cast<double>(x < 0);
}
double power(double x, double y) {
  return std::pow(x, y);
}

using Unary = double (*)(double);
using Binary = double (*)(double, double);

/// All of libm or exact, so that every rank computes the same bits.
constexpr std::array<std::pair<const char*, Unary>, 25> unary{{
    {"sin", ::sin},     {"cos", ::cos},     {"tan", ::tan},     {"asin", ::asin}, {"acos", ::acos},
    {"atan", ::atan},   {"sinh", ::sinh},   {"cosh", ::cosh},   {"tanh", ::tanh}, {"asinh", ::asinh},
    {"acosh", ::acosh}, {"atanh", ::atanh}, {"exp", ::exp},     {"ln", ::log},    {"log", ::log},
    {"log10", ::log10}, {"sqrt", ::sqrt},   {"abs", ::fabs},    {"erf", ::erf},   {"erfc", ::erfc},
    {"floor", ::floor}, {"ceil", ::ceil},   {"round", ::round}, {"step", step},   {"sign", sign},
}};
constexpr std::array<std::pair<const char*, Binary>, 6> binary{{
    {"atan2", ::atan2},
    {"pow", power},
    {"mod", ::fmod},
    {"min", ::fmin},
    {"max", ::fmax},
    {"bessel_j", bessel_j},
}};

bool letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

[[noreturn]] void refuse(const std::string& text, std::size_t at, const std::string& message) {
  throw std::invalid_argument(fmt::format("expression {}, position {}: {}", quoted(text), at + 1, message));
}

std::size_t after_number(std::string_view text, std::size_t at) {
  while (at < text.size() && (digit(text[at]) || text[at] == '.')) ++at;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t power = at + 1;
    if (power < text.size() && (text[power] == '+' || text[power] == '-')) ++power;
    if (power < text.size() && digit(text[power])) {
      at = power;
      while (at < text.size() && digit(text[at])) ++at;
    }
  }
  return at;
}

void check_name(const std::string& text, std::size_t at, std::size_t end, const std::vector<std::string>& variables) {
  const std::string name = text.substr(at, end - at);
  const std::size_t next = text.find_first_not_of(" \t", end);
  const bool called = next != std::string::npos && text[next] == '(';
  const std::vector<std::string>& functions = Expression::function_names();
  std::vector<std::string> values = variables;
  values.emplace_back("pi");
  const auto among = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (among(called ? functions : values)) return;
  if (!called && among(functions)) refuse(text, at, "'" + name + "' is a function; write " + name + "(...)");
  if (called && among(values)) refuse(text, at, "'" + name + "' is no function; is a '*' missing behind it?");
  std::vector<std::string> all = values;
  all.insert(all.end(), functions.begin(), functions.end());
  const std::string near = nearest_word(name, all);
  refuse(text, at,
         (called ? "unknown function '" : "unknown name '") + name + "'" +
             (near.empty() ? "; valid: " + listed(called ? functions : values) : ", did you mean '" + near + "'?"));
}

/// What muParser would take in another sense, or complain about in its own words.
void check_words(const std::string& text, const std::vector<std::string>& variables) {
  if (text.find_first_not_of(" \t") == std::string::npos) refuse(text, 0, "there is nothing in it");
  if (text.size() > longest)
    throw std::invalid_argument(fmt::format("expression of {} letters; at most {} are read", text.size(), longest));
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (digit(c) || (c == '.' && at + 1 < text.size() && digit(text[at + 1]))) {
      const std::size_t end = after_number(text, at);
      if (end < text.size() && letter(text[end]))
        refuse(
            text, end,
            fmt::format("a number is followed by a name; write '*' between them (numbers are in SI, without units)"));
      at = end;
    } else if (letter(c)) {
      std::size_t end = at;
      while (end < text.size() && (letter(text[end]) || digit(text[end]))) ++end;
      check_name(text, at, end, variables);
      at = end;
    } else if (c == '=' && at + 1 < text.size() && text[at + 1] == '=') {
      at += 2;
    } else if (c == '=' && (at == 0 || std::string_view("<>!").find(text[at - 1]) == std::string_view::npos)) {
      refuse(text, at, "'=' assigns; write '==' to compare");
    } else {
      if (std::string_view(" \t+-*/^()<>!=&|?:,.").find(c) == std::string_view::npos)
        refuse(text, at, "a character that no expression contains");
      ++at;
    }
  }
}

std::string in_words(const mu::Parser::exception_type& problem) {
  switch (problem.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
      return "the expression ends too early";
    case mu::ecUNEXPECTED_OPERATOR:
      return "an operator has nothing to act on, near '" + problem.GetToken() + "'";
    case mu::ecUNEXPECTED_PARENS:
      return "a parenthesis '" + problem.GetToken() + "' is out of place";
    case mu::ecMISSING_PARENS:
      return "a ')' is missing";
    case mu::ecUNEXPECTED_ARG_SEP:
    case mu::ecUNEXPECTED_ARG:
      return "a ',' is out of place";
    case mu::ecTOO_MANY_PARAMS:
      return "too many arguments for the function '" + problem.GetToken() + "'";
    case mu::ecTOO_FEW_PARAMS:
      return "too few arguments for the function '" + problem.GetToken() + "'";
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
      return "an operator is missing before '" + problem.GetToken() + "'";
    case mu::ecUNEXPECTED_CONDITIONAL:
    case mu::ecMISSING_ELSE_CLAUSE:
    case mu::ecMISPLACED_COLON:
      return "'?' and ':' do not form a choice 'condition ? value : other value'";
    default:
      return problem.GetMsg();
  }
}

}  // namespace

/// The parser reads the variables from `values`, which is why it is not copied.
struct Expression::Parsed {
  std::string text;
  std::vector<std::string> names, used;
  mutable std::vector<double> values;
  mu::Parser parser;
};

const std::vector<std::string>& Expression::function_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, f] : unary) all.emplace_back(name);
    for (const auto& [name, f] : binary) all.emplace_back(name);
    return all;
  }();
  return names;
}

Expression::Expression(const std::string& text, std::vector<std::string> variables) {
  check_words(text, variables);
  auto parsed = std::make_shared<Parsed>();
  parsed->text = text;
  parsed->names = std::move(variables);
  parsed->values.assign(parsed->names.size(), 0.0);
  mu::Parser& parser = parsed->parser;
  try {
    parser.EnableOptimizer(false);  // it reorders: floor((n + 1)/3) of n = 5 would be 1
    parser.ClearFun();
    parser.ClearConst();
    for (const auto& [name, f] : unary) parser.DefineFun(name, f);
    for (const auto& [name, f] : binary) parser.DefineFun(name, f);
    parser.DefineConst("pi", std::numbers::pi);
    for (std::size_t i = 0; i < parsed->names.size(); ++i)
      parser.DefineVar(parsed->names[i], parsed->values.data() + i);
    parser.SetExpr(text);
    for (const auto& [name, place] : parser.GetUsedVar()) parsed->used.push_back(name);
    fractional_order = false;
    // The first evaluations parse, and make the room that the later ones work in.
    parser.Eval();
    parser.Eval();
    if (fractional_order)
      refuse(text, text.find("bessel_j"), "the order of bessel_j is not a whole number (its first argument)");
    if (parser.GetNumResults() != 1) refuse(text, text.find(','), "a ',' outside of a function's arguments");
  } catch (const mu::Parser::exception_type& problem) {
    const auto at = static_cast<std::size_t>(std::max(problem.GetPos(), 0));
    refuse(text, std::min(at, text.size()), in_words(problem));
  }
  parsed_ = std::move(parsed);
}

double Expression::operator()(std::span<const double> values) const {
  std::copy_n(values.begin(), std::min(values.size(), parsed_->values.size()), parsed_->values.begin());
  return parsed_->parser.Eval();
}

bool Expression::uses(const std::string& variable) const {
  return std::find(parsed_->used.begin(), parsed_->used.end(), variable) != parsed_->used.end();
}

const std::string& Expression::text() const {
  return parsed_->text;
}

namespace {

class ExpressionFormula final : public Formula {
 public:
  ExpressionFormula(Expression expression, double scale, double offset)
      : expression_(std::move(expression)), scale_(scale), offset_(offset) {}
  double value(double t, const Vec3& x) const override {
    return scale_ * expression_(std::array{t, x[0], x[1], x[2]}) + offset_;
  }

 private:
  Expression expression_;
  double scale_, offset_;
};

}  // namespace

SpaceTimeFunction parse_field_expression(const std::string& text, double scale, double offset) {
  const Expression expression(text, {"t", "x", "y", "z"});
  auto formula = std::make_shared<const ExpressionFormula>(expression, scale, offset);
  if (expression.uses("x") || expression.uses("y") || expression.uses("z"))
    return SpaceTimeFunction::formula(std::move(formula));
  if (expression.uses("t")) return SpaceTimeFunction(TimeFunction::formula(std::move(formula)));
  return SpaceTimeFunction::constant(formula->value(0, {0, 0, 0}));
}

}  // namespace tenon::scene
