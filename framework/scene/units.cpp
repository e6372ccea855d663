// SPDX-License-Identifier: BSD-3-Clause
// Reads numbers with units and converts them to SI by UDUNITS-2.
#include "framework/scene/units.hpp"

#include "framework/scene/expression.hpp"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "framework/base/error.hpp"
#include "framework/scene/tree.hpp"

namespace tenon::scene {
namespace {

struct UnitDeleter {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using UnitPointer = std::unique_ptr<ut_unit, UnitDeleter>;

bool is_letter(char c) {
  const auto u = static_cast<unsigned char>(c);
  return (u >= 'a' && u <= 'z') || (u >= 'A' && u <= 'Z') || u >= 0x80 || u == '%' || u == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Signs of multiplication that are no part of a name.
std::size_t sign_length(std::string_view text) {
  for (const std::string_view sign : {"·", "×"})
    if (text.substr(0, sign.size()) == sign) return sign.size();
  return 0;
}

/// "m⁻²" as "m^-2", which is all that UDUNITS reads.
std::string with_plain_exponents(std::string_view unit) {
  static constexpr std::array<std::string_view, 12> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹", "⁻", "⁺"};
  std::string text;
  bool in_exponent = false;
  for (std::size_t i = 0; i < unit.size();) {
    const auto sign =
        std::find_if(raised.begin(), raised.end(), [&](std::string_view r) { return unit.substr(i, r.size()) == r; });
    const bool is_raised = sign != raised.end();
    if (is_raised && !in_exponent) text += '^';
    text += is_raised ? "0123456789-+"[sign - raised.begin()] : unit[i];
    i += is_raised ? sign->size() : 1;
    in_exponent = is_raised;
  }
  return text;
}

/// Whether the digits at `begin` are an exponent: "m2", "m-2", "m^2", "m^-2", "m**2", "(m s)2". UDUNITS reads "m -2"
/// and "m^2.5" as products with a number.
bool is_exponent(std::string_view unit, std::size_t begin) {
  const auto after_operator = [&](std::size_t end) {
    return (end >= 1 && unit[end - 1] == '^') || (end >= 2 && unit[end - 1] == '*' && unit[end - 2] == '*');
  };
  if (begin == 0) return false;
  const char before = unit[begin - 1];
  if (is_letter(before) || before == ')' || after_operator(begin)) return true;
  if (before != '-' && before != '+') return false;
  return after_operator(begin - 1) || (before == '-' && begin >= 2 && is_letter(unit[begin - 2]));
}

/// The names in a unit: "W" "m" "K" of "W/(m K)". Nothing if the text holds what no unit does (UDUNITS also reads
/// factors, origins and logarithms, which would turn a slip of the pen into another number).
std::optional<std::vector<std::string>> names_in(std::string_view unit) {
  std::vector<std::string> names;
  int open = 0;
  for (std::size_t i = 0; i < unit.size();) {
    const std::size_t begin = i;
    if (const std::size_t length = sign_length(unit.substr(i)); length > 0) {
      i += length;
    } else if (is_letter(unit[i])) {
      while (i < unit.size() && is_letter(unit[i]) && sign_length(unit.substr(i)) == 0) ++i;
      names.emplace_back(unit.substr(begin, i - begin));
    } else if (is_digit(unit[i])) {
      while (i < unit.size() && is_digit(unit[i])) ++i;
      const bool one = unit.substr(begin, i - begin) == "1" &&
                       (begin == 0 || std::string_view(" (/*").find(unit[begin - 1]) != std::string_view::npos);
      if (!one && (i - begin > 2 || !is_exponent(unit, begin))) return std::nullopt;
    } else if (std::string_view(" ()/*^.+-").find(unit[i]) != std::string_view::npos) {
      open += unit[i] == '(' ? 1 : unit[i] == ')' ? -1 : 0;
      if (open < 0) return std::nullopt;
      ++i;
    } else {
      return std::nullopt;
    }
  }
  return open == 0 ? std::optional(names) : std::nullopt;
}

/// The units database, read once. UDUNITS' parser works on variables of its own that all systems share, which is why
/// this is one object behind a lock rather than one per scene; nothing in it changes an answer.
class UnitSystem {
 public:
  static UnitSystem& instance() {
    static UnitSystem system;
    return system;
  }

  /// How `unit` converts to the SI unit `to`. Throws std::invalid_argument.
  Conversion conversion(const std::string& unit, const std::string& to) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = known_.find({unit, to});
    if (found != known_.end()) return found->second;
    const Conversion made = make(unit, to);
    known_.emplace(std::make_pair(unit, to), made);
    return made;
  }

 private:
  UnitSystem() {
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_)
      throw Error(
          ExitCode::file,
          "the units database of UDUNITS-2 cannot be read; install the package libudunits2-data (Debian), or set "
          "UDUNITS2_XML_PATH to its file udunits2.xml");
    if (const UnitPointer degree = parse("degree")) ut_map_name_to_unit("deg", UT_ASCII, degree.get());
  }

  UnitPointer parse(const std::string& unit) const {
    return UnitPointer(ut_parse(system_.get(), unit.c_str(), UT_UTF8));
  }

  Conversion make(const std::string& unit, const std::string& to) const {
    const bool difference = to == temperature_difference;
    const UnitPointer target = parse(difference ? "K" : to);
    if (!target) throw std::logic_error("the schema asks for the unit '" + to + "', which does not exist");
    const UnitPointer source = parse_checked(unit, to);
    const std::optional<Conversion> linear = linear_conversion(*source, *target);
    if (!linear) {
      if ((to == "K" || difference) && (unit == "C" || unit == "F"))
        throw std::invalid_argument(quoted(unit) + " is the " + (unit == "C" ? "coulomb" : "farad") +
                                    " (did you mean 'deg" + unit + "'?)");
      const std::string kind = kind_of(*source);
      throw std::invalid_argument(kind.empty() ? "its unit does not fit" : "it is " + kind);
    }
    if (difference && linear->offset != 0)
      throw std::invalid_argument("it is a point on a temperature scale, not a difference; write the difference in K");
    return *linear;
  }

  /// Parses a unit of the user, naming the part that is wrong.
  UnitPointer parse_checked(const std::string& written, const std::string& to) const {
    const std::string unit = with_plain_exponents(written);
    const auto names = unit.size() <= 100 ? names_in(unit) : std::nullopt;
    if (!names) throw std::invalid_argument(quoted(written) + " is not a unit");
    for (const std::string& name : *names)
      if (!is_unit(name)) throw std::invalid_argument("there is no unit " + quoted(name) + offer(name, to));
    UnitPointer parsed = parse(unit);
    if (!parsed) throw std::invalid_argument(quoted(written) + " is not a unit");
    return parsed;
  }

  bool is_unit(const std::string& name) const {
    for (const char* keyword : {"since", "after", "from", "ref", "re", "lg", "ln"})
      if (name == keyword) return false;
    return name == "per" || name == "PER" || parse(name) != nullptr;
  }

  /// The nearest unit, preferring those that would have the right dimension.
  std::string offer(const std::string& name, const std::string& to) const {
    const UnitPointer target = parse(to == temperature_difference ? "K" : to);
    std::vector<std::string> fitting;
    for (const std::string& unit : common_units())
      if (const UnitPointer parsed = parse(unit); parsed && linear_conversion(*parsed, *target))
        fitting.push_back(unit);
    std::string near = nearest_word(name, fitting);
    if (near.empty()) near = nearest_word(name, common_units());
    return near.empty() ? "" : " (did you mean '" + near + "'?)";
  }

  /// UDUNITS also converts between reciprocals (5 Hz to 0.2 s) and logarithms; only straight lines are right here.
  static std::optional<Conversion> linear_conversion(const ut_unit& from, const ut_unit& to) {
    const std::unique_ptr<cv_converter, void (*)(cv_converter*)> converter(
        ut_get_converter(const_cast<ut_unit*>(&from), const_cast<ut_unit*>(&to)), cv_free);
    if (!converter) return std::nullopt;
    const double at0 = cv_convert_double(converter.get(), 0.0), at1 = cv_convert_double(converter.get(), 1.0),
                 at2 = cv_convert_double(converter.get(), 2.0);
    const double size = std::abs(at0) + std::abs(at1) + std::abs(at2);
    if (!std::isfinite(size) || std::abs((at2 - at1) - (at1 - at0)) > 1e-12 * size) return std::nullopt;
    if (at0 == 0) return Conversion{at1, 0};
    // at1 - at0 cancels digits; seen from far away the scale is right to round-off.
    const double far = 1e12;
    const double scale = (cv_convert_double(converter.get(), far) - at0) / far;
    return Conversion{std::abs(scale - 1) < 1e-14 ? 1.0 : scale, at0};
  }

  std::string kind_of(const ut_unit& unit) const {
    for (const KnownUnit& known : known_units()) {
      if (known.unit == temperature_difference) continue;
      const UnitPointer candidate = parse(known.unit);
      if (candidate && linear_conversion(unit, *candidate)) return known.name;
    }
    return {};
  }

  struct SystemDeleter {
    void operator()(ut_system* system) const { ut_free_system(system); }
  };
  std::unique_ptr<ut_system, SystemDeleter> system_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Conversion> known_;
};

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1));
}

/// Splits "8930 kg/m^3"; the number part is empty if the text does not begin with a number.
std::pair<std::string, std::string> split(const std::string& text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < text.size() && is_digit(text[i])) ++i;
    return i - begin;
  };
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  std::size_t count = digits();
  if (i < text.size() && text[i] == '.') ++i, count += digits();
  if (count == 0) return {"", text};
  const std::size_t mantissa_end = i;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) i = mantissa_end;  // "5 eV" without the blank
  }
  return {text.substr(0, i), trimmed(std::string_view(text).substr(i))};
}

/// number * 10^shift, correctly rounded, so that "80 us" is the same double as 8e-5.
std::optional<double> decimal(const std::string& number, int shift) {
  std::string text = number.front() == '+' ? number.substr(1) : number;
  long exponent = shift;
  if (const auto e = text.find_first_of("eE"); e != std::string::npos) {
    const std::string written = text.substr(text[e + 1] == '+' ? e + 2 : e + 1);
    long value = 0;
    if (std::from_chars(written.data(), written.data() + written.size(), value).ec != std::errc() ||
        std::abs(value) > 10000)
      return std::nullopt;
    exponent += value;
    text.resize(e);
  }
  text += 'e';
  text += std::to_string(exponent);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The k of a scale that is meant to be 10^k.
std::optional<int> power_of_ten(double scale) {
  if (!(scale > 0)) return std::nullopt;
  const int k = static_cast<int>(std::lround(std::log10(scale)));
  if (std::abs(scale - std::pow(10.0, k)) > 8 * std::numeric_limits<double>::epsilon() * scale) return std::nullopt;
  return k;
}

}  // namespace

Quantity read_quantity(const std::string& text, const std::string& to) {
  const UnitExample expected = unit_example(to);
  const auto fail = [&](const std::string& why) {
    return std::invalid_argument(quoted(text) + (why.empty() ? "" : ": " + why) + "; expected " + expected.name +
                                 " such as " + expected.example);
  };
  const auto [number, unit] = split(trimmed(text));
  if (number.empty()) throw fail("it does not begin with a finite number");
  if (!unit.empty() && unit.front() == ',') throw fail("write a decimal point, not a comma");
  Quantity quantity;
  quantity.unit = unit.empty() ? (to == temperature_difference ? "K" : to) : unit;
  try {
    if (!unit.empty()) quantity.conversion = UnitSystem::instance().conversion(unit, to);
  } catch (const std::invalid_argument& wrong) {
    throw fail(wrong.what());
  }
  const std::optional<int> shift = power_of_ten(quantity.conversion.scale);
  const bool exact = shift && quantity.conversion.offset == 0;
  const std::optional<double> value = decimal(number, exact ? *shift : 0);
  if (!value) throw fail("the number is too large or too small");
  quantity.si = exact ? *value : quantity.conversion.to_si(*value);
  if (!std::isfinite(quantity.si)) throw fail("the number is too large");
  return quantity;
}

std::optional<double> number_in_si(const std::string& text) {
  for (const KnownUnit& known : known_units()) {
    if (known.unit == temperature_difference) continue;
    try {
      return parse_quantity(text, known.unit);  // a plain number is of every kind
    } catch (const std::invalid_argument&) {    // of another kind
      continue;
    }
  }
  return std::nullopt;
}

double parse_quantity(const std::string& text, const std::string& to) {
  return read_quantity(text, to).si;
}

}  // namespace tenon::scene
