// SPDX-License-Identifier: BSD-3-Clause
// A place in the text or bytes of a Gmsh file, which reads one checked value after another. Private to the room.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace tenon::mesh_file {

class GmshCursor {
 public:
  GmshCursor(std::string path, std::string contents) : path_(std::move(path)), contents_(std::move(contents)) {}

  /// How values are read from now on: as text, or as bytes (of the other endianness if `swapped`).
  void set_binary(bool swapped) { binary_ = true, swapped_ = swapped; }
  bool binary() const { return binary_; }

  /// Name of the next section ("Nodes" for "$Nodes"), with the cursor behind its line; empty at the end of the file.
  std::string next_section();
  /// Moves behind "$EndNAME", which must come next.
  void end_section(const std::string& name);
  /// Moves behind "$EndNAME", wherever it is.
  void skip_section(const std::string& name);

  std::int32_t integer32(const char* what);  ///< int of the format
  std::int64_t integer64(const char* what);  ///< size_t of the format
  double real(const char* what);
  /// A number of things of at least `bytes` each (of a binary file; in text, `fields` numbers): refused if the rest of
  /// the file cannot hold them.
  std::int64_t count(const char* what, std::size_t bytes, std::size_t fields);
  void require_room(std::int64_t count, const char* what, std::size_t bytes, std::size_t fields) const;

  /// Numbers that are text in binary files too.
  std::int64_t text_integer(const char* what);
  double text_real(const char* what);
  std::string quoted_text(const char* what);
  void finish_line();
  /// Four raw bytes, which tell the endianness.
  std::int32_t raw_integer32(const char* what);

  /// Throws Error(file) with the path and the line (of text) or byte (of a binary file).
  [[noreturn]] void refuse_here(const std::string& what) const;

 private:
  std::string_view token(const char* what);
  void skip_space();
  template <class T>
  T raw(const char* what) {
    if (contents_.size() - at_ < sizeof(T)) refuse_here(std::string("the file ends (truncated?), expected ") + what);
    unsigned char bytes[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes[i] = static_cast<unsigned char>(contents_[at_ + (swapped_ ? sizeof(T) - 1 - i : i)]);
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  std::string path_, contents_, section_;
  std::size_t at_ = 0;
  bool binary_ = false, swapped_ = false;
};

}  // namespace tenon::mesh_file
