// SPDX-License-Identifier: BSD-3-Clause
// Turns YAML text into the bare tree, safe against every kind of text.
#include "framework/scene/tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <unordered_map>

#include "framework/scene/yaml_text.hpp"

namespace tenon::scene {

TreeMember* TreeNode::find(const std::string& key) {
  const auto found = std::find_if(members.begin(), members.end(), [&](const TreeMember& m) { return m.key == key; });
  return found == members.end() ? nullptr : &*found;
}

const TreeMember* TreeNode::find(const std::string& key) const {
  return const_cast<TreeNode*>(this)->find(key);
}

std::string TreeNode::described() const {
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::scalar:
      return quoted(text);
    case Kind::list:
      return "a list";
    case Kind::mapping:
      break;
  }
  return "a mapping";
}

namespace {

/// Ends the reading of a document that cannot become a tree.
struct Refused {
  Place place;
  std::string message;
};

std::size_t count_nodes(const TreeNode& node) {
  std::size_t count = 1;
  for (const TreeNode& item : node.items) count += count_nodes(item);
  for (const TreeMember& member : node.members) count += 1 + count_nodes(member.value);
  return count;
}

int depth_of(const TreeNode& node) {
  int depth = 0;
  for (const TreeNode& item : node.items) depth = std::max(depth, depth_of(item));
  for (const TreeMember& member : node.members) depth = std::max(depth, depth_of(member.value));
  return depth + 1;
}

/// Builds the tree from the events of the YAML parser.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const LineIndex& lines, std::shared_ptr<const std::string> file, const Place* fixed_place,
              Diagnostics& diagnostics)
      : lines_(lines), file_(std::move(file)), fixed_place_(fixed_place), diagnostics_(diagnostics) {}

  std::optional<TreeNode> take() { return std::move(root_); }
  Place place(const YAML::Mark& mark) const {
    if (fixed_place_ != nullptr) return *fixed_place_;
    return {file_, mark.line + 1, lines_.column(mark.line, mark.column)};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (started_) throw Refused{place(mark), "text after the end of the scene; a scene is one YAML document"};
    started_ = true;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    TreeNode node;
    node.place = place(mark);
    add(std::move(node), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(mark, tag);
    TreeNode node;
    node.kind = TreeNode::Kind::scalar;
    node.place = place(mark);
    node.text = value;
    add(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw Refused{place(mark), "an alias inside the block that it names"};
    if (static_cast<int>(open_.size()) + found->second.depth > TreeLimits::depth)
      throw Refused{place(mark), too_deep()};
    charge(found->second.nodes, place(mark));
    TreeNode copy = found->second.node;
    copy.place = place(mark);
    add(std::move(copy), YAML::NullAnchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, TreeNode::Kind::list);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, TreeNode::Kind::mapping);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    TreeNode node;
    YAML::anchor_t anchor;
    std::optional<TreeMember> member;           ///< its key is read, its value is not
    bool repeated = false;                      ///< the member is a duplicate, to be dropped
    std::unordered_map<std::string, int> keys;  ///< with the line of each
    std::vector<TreeNode> merged;               ///< values of `<<`
  };
  struct Anchored {
    TreeNode node;
    std::size_t nodes;
    int depth;
  };

  static std::string too_deep() {
    return "blocks are nested more than " + std::to_string(TreeLimits::depth) + " deep; a scene needs fewer than ten";
  }
  void charge(std::size_t nodes, const Place& at) {
    nodes_ += nodes;
    if (nodes_ > TreeLimits::nodes)
      throw Refused{at, "the scene has more than " + std::to_string(TreeLimits::nodes) +
                            " values (aliases counted as often as they are used)"};
  }
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw Refused{place(mark), "a YAML tag " + quoted(tag) + "; scenes use no tags, remove it"};
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, TreeNode::Kind kind) {
    refuse_tag(mark, tag);
    if (static_cast<int>(open_.size()) >= TreeLimits::depth) throw Refused{place(mark), too_deep()};
    Open& frame = open_.emplace_back();
    frame.node.kind = kind;
    frame.node.place = place(mark);
    frame.anchor = anchor;
  }
  void close() {
    Open frame = std::move(open_.back());
    open_.pop_back();
    for (const TreeNode& from : frame.merged) merge(from, frame);
    add(std::move(frame.node), frame.anchor);
  }

  /// Puts a finished node where the parent expects it: root, item, key or value.
  void add(TreeNode node, YAML::anchor_t anchor) {
    charge(1, node.place);
    if (anchor != YAML::NullAnchor) {
      const std::size_t nodes = count_nodes(node);
      charge(nodes, node.place);  // the copy kept for the aliases
      anchors_.insert_or_assign(anchor, Anchored{node, nodes, depth_of(node)});
    }
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (Open& parent = open_.back(); parent.node.kind == TreeNode::Kind::list) {
      parent.node.items.push_back(std::move(node));
    } else if (parent.member) {
      add_value(parent, std::move(node));
    } else {
      add_key(parent, std::move(node));
    }
  }
  void add_key(Open& parent, TreeNode node) {
    if (node.kind != TreeNode::Kind::scalar)
      throw Refused{node.place, "found " + node.described() + " in the place of a key; expected a word, then ':'"};
    parent.repeated = node.text != "<<" && !parent.keys.emplace(node.text, node.place.line).second;
    if (parent.repeated) complain_twice(parent, node);
    parent.member = TreeMember{std::move(node.text), std::move(node.place), {}};
  }
  void complain_twice(const Open& parent, const TreeNode& key) {
    const int line = parent.keys.at(key.text);
    const std::string where = line == 0 ? std::string() : " (first in line " + std::to_string(line) + ")";
    diagnostics_.error(key.place.where(), "key " + quoted(key.text) + " is given twice" + where + "; keep one");
  }
  void add_value(Open& parent, TreeNode node) {
    TreeMember member = std::move(*parent.member);
    parent.member.reset();
    if (parent.repeated) return;
    if (member.key == "<<") {
      parent.merged.push_back(std::move(node));
      return;
    }
    member.value = std::move(node);
    parent.node.members.push_back(std::move(member));
  }
  /// YAML's merge key: adds what the mapping does not say itself.
  void merge(const TreeNode& from, Open& into) {
    if (from.kind == TreeNode::Kind::list) {
      for (const TreeNode& item : from.items) merge_mapping(item, into);
    } else {
      merge_mapping(from, into);
    }
  }
  void merge_mapping(const TreeNode& from, Open& into) {
    if (from.kind != TreeNode::Kind::mapping)
      throw Refused{from.place, "found " + from.described() + " after '<<'; expected an alias of a mapping"};
    for (const TreeMember& member : from.members)
      if (into.keys.emplace(member.key, member.place.line).second) into.node.members.push_back(member);
  }

  const LineIndex& lines_;
  std::shared_ptr<const std::string> file_;
  const Place* fixed_place_;
  Diagnostics& diagnostics_;
  bool started_ = false;
  std::size_t nodes_ = 0;
  std::vector<Open> open_;
  std::unordered_map<YAML::anchor_t, Anchored> anchors_;
  std::optional<TreeNode> root_;
};

}  // namespace

std::optional<TreeNode> read_tree(const std::string& text, const std::string& file, const Place* fixed_place,
                                  Diagnostics& diagnostics) {
  const auto name = std::make_shared<const std::string>(file);
  const auto refuse = [&](const Place& place, const std::string& message) {
    diagnostics.error(fixed_place != nullptr ? fixed_place->where() : place.where(), message);
    return std::nullopt;
  };
  if (const auto fault = fault_in_bytes(text)) return refuse({name, fault->line, fault->column}, fault->message);

  const LineIndex lines(text);
  TreeBuilder builder(lines, name, fixed_place, diagnostics);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    // The second call finds either the end or a second document, which the builder refuses.
    if (parser.HandleNextDocument(builder)) parser.HandleNextDocument(builder);
  } catch (const Refused& refused) {
    return refuse(refused.place, refused.message);
  } catch (const YAML::Exception& error) {
    return refuse(error.mark.is_null() ? Place{name, lines.count(), 1} : builder.place(error.mark),
                  plain_words(error.msg));
  }
  std::optional<TreeNode> root = builder.take();
  if (!root) {
    root.emplace();
    root->place = fixed_place != nullptr ? *fixed_place : Place{name, 1, 1};
  }
  return root;
}

}  // namespace tenon::scene
