// SPDX-License-Identifier: BSD-3-Clause
// ParaView's list of frames: which file shows which part at which time.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace tenon {

struct PvdEntry {
  double time = 0;  ///< s
  int part = 0;
  std::string name;  ///< of the part
  std::string file;  ///< relative to the folder of the list
};

/// Text of a .pvd; times are written with 17 digits, so that reading gives the same bits.
std::string format_pvd(std::span<const PvdEntry> entries);
/// Throws Error(file) if it is not there or not a .pvd.
std::vector<PvdEntry> read_pvd(const std::string& path);
/// Sources of the pieces that a .pvtu lists. Throws Error(file).
std::vector<std::string> read_pieces(const std::string& path);

/// `text` as it may stand in an attribute of XML.
std::string xml_escape(std::string_view text);

}  // namespace tenon
