// What libc++ 13, Debian's emscripten's, lacks of C++20 and vmesh uses; included before everything. Nothing with a
// newer one. So the sources are those of all other builds.
#pragma once
#if defined(__cplusplus) && __cplusplus >= 202002L
#include <version>
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 15000

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <compare>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

_LIBCPP_BEGIN_NAMESPACE_STD

namespace ranges {

template <class Range, class Test, class Map = identity>
constexpr bool all_of(Range&& range, Test test, Map map = {}) {
  for (auto&& x : range)
    if (!invoke(test, invoke(map, x))) return false;
  return true;
}

template <class Range, class Test, class Map = identity>
constexpr bool any_of(Range&& range, Test test, Map map = {}) {
  for (auto&& x : range)
    if (invoke(test, invoke(map, x))) return true;
  return false;
}

template <class Range, class Test, class Map = identity>
constexpr auto find_if(Range&& range, Test test, Map map = {}) {
  return std::find_if(std::begin(range), std::end(range), [&](auto&& x) { return invoke(test, invoke(map, x)); });
}

template <class Range, class Value, class Map = identity>
constexpr auto find(Range&& range, const Value& value, Map map = {}) {
  return std::find_if(std::begin(range), std::end(range), [&](auto&& x) { return invoke(map, x) == value; });
}

template <class Range, class Test, class Map = identity>
constexpr auto count_if(Range&& range, Test test, Map map = {}) {
  return std::count_if(std::begin(range), std::end(range), [&](auto&& x) { return invoke(test, invoke(map, x)); });
}

template <class Range, class Test, class Value>
constexpr void replace_if(Range&& range, Test test, const Value& value) {
  std::replace_if(std::begin(range), std::end(range), test, value);
}

}  // namespace ranges

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

/// Of one thread.
template <class T>
class atomic_ref {
 public:
  explicit atomic_ref(T& object) noexcept : object_(object) {}
  template <class... Order>
  T load(Order...) const noexcept {
    return object_;
  }
  template <class... Order>
  void store(T value, Order...) const noexcept {
    object_ = value;
  }

 private:
  T& object_;
};

template <class T>
constexpr auto operator<=>(const vector<T>& a, const vector<T>& b) {
  const size_t common = std::min(a.size(), b.size());
  for (size_t i = 0; i < common; ++i) {
    if (const auto order = a[i] <=> b[i]; order != 0) return order;
  }
  return decltype(a[0] <=> b[0])(a.size() <=> b.size());
}

/// As the standard has it, but of decimals with as few digits as possible always the one nearest to `value`.
template <class Real>
requires is_floating_point_v<Real> to_chars_result to_chars(char* first, char* last, Real value) {
  char text[400];
  if (!isfinite(value)) {
    std::snprintf(text, sizeof text, "%s%s", signbit(value) ? "-" : "", isinf(value) ? "inf" : "nan");
  } else {
    constexpr int kMost = numeric_limits<Real>::max_digits10;
    const auto comes_back = [&] {
      return (is_same_v<Real, float> ? static_cast<Real>(strtof(text, nullptr))
                                     : static_cast<Real>(strtod(text, nullptr))) == value;
    };
    int digits = 1;
    for (; digits <= kMost; ++digits) {
      std::snprintf(text, sizeof text, "%.*e", digits - 1, static_cast<double>(value));
      if (comes_back()) break;
    }
    // Fixed notation where it is no longer.
    const int exponent = std::atoi(std::strchr(text, 'e') + 1);
    char fixed[400];
    std::snprintf(fixed, sizeof fixed, "%.*f", std::max(0, digits - 1 - exponent), static_cast<double>(value));
    if (std::strlen(fixed) <= std::strlen(text)) std::strcpy(text, fixed);
  }
  const size_t length = std::strlen(text);
  if (static_cast<size_t>(last - first) < length) return {last, errc::value_too_large};
  return {std::copy(text, text + length, first), errc()};
}

/// In fixed notation, the only one that is asked for.
inline to_chars_result to_chars(char* first, char* last, double value, chars_format, int decimals) {
  const int length = std::snprintf(first, static_cast<size_t>(last - first), "%.*f", decimals, value);
  if (length < 0 || length >= last - first) return {last, errc::value_too_large};
  return {first + length, errc()};
}

/// Where the number at the beginning of `text` ends, in the notation that from_chars() reads: no sign but "-", and no
/// hexadecimal digits. 0: there is none.
inline size_t end_of_number(const string& text) {
  const size_t start = text.starts_with('-') ? 1 : 0;
  const char c = start < text.size() ? text[start] : '\0';
  if (!(isdigit(static_cast<unsigned char>(c)) || (c != '\0' && strchr(".iInN", c) != nullptr))) return 0;
  if (c == '0' && start + 1 < text.size() && tolower(text[start + 1]) == 'x') return start + 1;
  char* end = nullptr;
  strtod(text.c_str(), &end);
  return static_cast<size_t>(end - text.c_str());
}

/// Rounds correctly, as musl's strtod() does.
template <class Real>
requires is_floating_point_v<Real> from_chars_result from_chars(const char* first, const char* last, Real& value) {
  string text(first, last);
  text.resize(end_of_number(text));
  if (text.empty()) return {first, errc::invalid_argument};
  const char* rest = first + text.size();
  const Real found = is_same_v<Real, float> ? static_cast<Real>(strtof(text.c_str(), nullptr))
                                            : static_cast<Real>(strtod(text.c_str(), nullptr));
  // What is infinite without saying so is out of range, and so is what is 0 with other digits in it.
  const bool too_large = isinf(found) && text.find_first_of("iI") == string::npos;
  const string digits = text.substr(0, text.find_first_of("eE"));
  const bool too_small = found == 0 && digits.find_first_of("123456789") != string::npos;
  if (too_large || too_small) return {rest, errc::result_out_of_range};
  value = found;
  return {rest, errc()};
}

_LIBCPP_END_NAMESPACE_STD

#endif
#endif
