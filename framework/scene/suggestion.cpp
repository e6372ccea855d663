// SPDX-License-Identifier: BSD-3-Clause
// Finds the word that the user most likely meant.
#include <algorithm>
#include <numeric>

#include "framework/scene/tree.hpp"

namespace tenon::scene {
namespace {

constexpr std::size_t longest_word = 64;  // longer ones are no misspellings of a key

/// Case, '-' and '_' are what people mix up first, so they do not count as a difference.
std::string folded(const std::string& word) {
  std::string result = word;
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-' || c == ' ') c = '_';
  }
  return result;
}

/// Damerau-Levenshtein distance (insertion, deletion, substitution, swap of neighbours).
int edit_distance(const std::string& a, const std::string& b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> before(columns), last(columns), now(columns);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < columns; ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last.back();
}

/// The one valid word that begins with, or contains, what was written.
std::string completed_word(const std::string& part, const std::vector<std::string>& valid) {
  if (part.size() < 3) return {};
  std::string found;
  for (const std::string& candidate : valid) {
    const std::string word = folded(candidate);
    if (word.size() < part.size() || word.find(part) == std::string::npos) continue;
    if (!found.empty() && found != candidate) return {};
    found = candidate;
  }
  return found;
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& valid) {
  if (word.empty() || word.size() > longest_word) return {};
  const std::string wanted = folded(word);
  // A third of the letters may be wrong; a single letter only if it differs in case.
  const int most = word.size() < 2 ? 0 : std::max(1, static_cast<int>(word.size()) / 3);
  int best = most + 1;
  std::string nearest;
  for (const std::string& candidate : valid) {
    const auto difference = static_cast<std::ptrdiff_t>(candidate.size()) - static_cast<std::ptrdiff_t>(word.size());
    if (std::abs(difference) >= best) continue;
    const int distance = edit_distance(wanted, folded(candidate));
    if (distance >= best || distance >= static_cast<int>(candidate.size())) continue;
    best = distance;
    nearest = candidate;
  }
  return nearest.empty() ? completed_word(wanted, valid) : nearest;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& valid) {
  const std::string near = nearest_word(word, valid);
  if (!near.empty()) return ", did you mean '" + near + "'?";
  return valid.empty() ? "; there is none to choose from" : "; valid: " + listed(valid);
}

std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t shown = 30;
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), shown); ++i) text += (i == 0 ? "" : ", ") + words[i];
  if (words.size() > shown) text += ", ... (" + std::to_string(words.size()) + " in all)";
  return text;
}

std::string quoted(const std::string& text) {
  constexpr std::size_t shown = 60;
  std::string result = "'";
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool starts_letter = (c & 0xC0U) != 0x80U;
    if (i >= shown && starts_letter) return result + "...'";
    result += c < 0x20 || c == 0x7F ? ' ' : text[i];
  }
  return result + "'";
}

}  // namespace tenon::scene
