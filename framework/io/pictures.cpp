// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <memory>

#include "framework/base/error.hpp"
#include "framework/io/body_view.hpp"
#include "framework/io/history_plot.hpp"
#include "framework/io/posix_file.hpp"
#include "framework/io/run_frames.hpp"

namespace tenon {

namespace {

// The most telling first; a field that is the same everywhere and always tells nothing.
constexpr const char* telling[] = {"eqps",     "temperature",  "von_mises", "damage",
                                   "pressure", "displacement", "velocity"};
constexpr std::size_t fields_by_default = 2;

bool varies(const RunFrames& frames, const std::string& field) {
  const ValueRange range = frames.range(field);
  return range.high > range.low;
}

std::vector<std::string> candidates(const RunFrames& frames, const PictureOptions& options) {
  std::vector<std::string> found;
  if (!options.fields.empty()) {
    for (const std::string& field : options.fields)
      if (frames.find(field) != nullptr) found.push_back(field);
    return found;
  }
  for (const char* field : telling)
    if (frames.find(field) != nullptr) found.emplace_back(field);
  if (found.empty() && !frames.fields().empty()) found.push_back(frames.fields().front().name);
  return found;
}

/// What to draw of one component: its frames, scanned, and the fields, the main one first.
struct Subject {
  RunFrames frames;
  std::vector<std::string> fields;
};

Subject make_subject(const std::string& folder, const std::string& component, const PictureOptions& options) {
  Subject subject{RunFrames(folder, component), {}};
  const std::vector<std::string> possible = candidates(subject.frames, options);
  for (const std::string& field : possible)
    if (!subject.frames.is_cut()) subject.frames.cut_if_hidden(field);
  subject.frames.scan(possible);
  for (const std::string& field : possible)
    if (!options.fields.empty() || varies(subject.frames, field)) subject.fields.push_back(field);
  if (subject.fields.empty() && !possible.empty()) subject.fields.push_back(possible.front());
  if (options.fields.empty() && subject.fields.size() > fields_by_default) subject.fields.resize(fields_by_default);
  return subject;
}

std::deque<Subject> make_subjects(const std::string& folder, const PictureOptions& options) {
  std::deque<Subject> subjects;
  std::string known;
  for (const std::string& component : RunFrames::components(folder)) {
    known += (known.empty() ? "" : ", ") + component;
    if (!options.component.empty() && component != options.component) continue;
    Subject subject = make_subject(folder, component, options);
    if (!subject.fields.empty() && !subject.frames.box().empty()) subjects.push_back(std::move(subject));
  }
  if (!subjects.empty()) return subjects;
  if (known.empty()) throw Error(ExitCode::file, fmt::format("{}: the run has written no frame yet", folder));
  throw Error(ExitCode::file,
              fmt::format("{}: nothing to draw: no such component, no such field, or no elements; components are {}",
                          folder, known));
}

std::string time_text(double time, double end) {
  const ShownUnit unit = shown_unit("s", end);
  return fmt::format("t = {:.{}f} {}", time * unit.scale,
                     end * unit.scale < 10    ? 3
                     : end * unit.scale < 100 ? 2
                                              : 1,
                     unit.name);
}

/// One window with views side by side and the time.
class Sheet {
 public:
  Sheet(const PictureOptions& options, const std::vector<std::pair<const Subject*, std::string>>& shown, const Box& box)
      : window_(options.width, options.height), end_(0) {
    const double width = 1.0 / static_cast<double>(shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const auto left = static_cast<double>(i) * width;
      const RunFrames& frames = shown[i].first->frames;
      views_.push_back(
          std::make_unique<BodyView>(window_, frames, shown[i].second, box, Place{left, 0, left + width, 1}));
      end_ = std::max(end_, frames.time(frames.size() - 1));
    }
    time_ = window_.add_text(0.02, 0.945, 26, false);
  }
  /// Frame `frame` of every view, or its last if it has fewer.
  void save(double time, const std::vector<std::size_t>& frames, const std::string& path) {
    for (std::size_t i = 0; i < views_.size(); ++i) views_[i]->show(frames[i]);
    time_->SetInput(time_text(time, end_).c_str());
    window_.save(path);
  }

 private:
  PictureWindow window_;
  double end_;
  std::vector<std::unique_ptr<BodyView>> views_;
  vtkSmartPointer<vtkTextActor> time_;
};

void draw_frames(const std::string& folder, const PictureOptions& options, const Subject& subject,
                 std::vector<std::string>& paths) {
  for (const std::string& field : subject.fields) {
    Sheet sheet(options, {{&subject, field}}, subject.frames.box());
    for (std::size_t frame = 0; frame < subject.frames.size(); ++frame) {
      paths.push_back(fmt::format("{}/{}_{}_{:04}.png", folder, subject.frames.component(), field, frame));
      sheet.save(subject.frames.time(frame), {frame}, paths.back());
    }
  }
}

void draw_last(const std::string& folder, const PictureOptions& options, const std::deque<Subject>& subjects,
               std::vector<std::string>& paths) {
  std::vector<std::pair<const Subject*, std::string>> shown;
  std::vector<std::size_t> frames;
  Box box;
  double time = 0;
  for (const Subject& subject : subjects) {
    shown.emplace_back(&subject, subject.fields.front());
    frames.push_back(subject.frames.size() - 1);
    box.add(subject.frames.box());
    time = std::max(time, subject.frames.time(frames.back()));
  }
  Sheet sheet(options, shown, box);
  paths.push_back(folder + "/last.png");
  sheet.save(time, frames, paths.back());
}

}  // namespace

std::vector<std::string> draw_pictures(const std::string& folder, const PictureOptions& options) {
  if (!has_display()) throw Error(ExitCode::file, "pictures need an X display: run under xvfb-run, or set DISPLAY");
  if (options.width < 200 || options.height < 150)
    throw Error(ExitCode::usage, fmt::format("a picture of {} x {} is too small to read; at least 200 x 150",
                                             options.width, options.height));
  const std::string pictures = folder + "/pictures";
  const std::deque<Subject> subjects = make_subjects(folder, options);
  make_folder(pictures);
  std::vector<std::string> paths;
  if (options.every_frame)
    for (const Subject& subject : subjects) draw_frames(pictures, options, subject, paths);
  draw_last(pictures, options, subjects, paths);
  if (std::filesystem::exists(folder + "/history.csv")) {
    paths.push_back(pictures + "/history.png");
    draw_history(folder + "/history.csv", paths.back(), options.width, options.height);
  }
  return paths;
}

}  // namespace tenon
