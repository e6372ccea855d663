// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/projection_rows.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

namespace tenon::transfer {

namespace {

/// The source items that values come from, numbered.
class Columns {
 public:
  Columns(const Side& source, const RowMap& interpolation, const TargetSamples& samples, const std::string& name)
      : by_node_(source.location == Location::node) {
    find_elements(source, samples, name);
    find_owners(source, interpolation);
    number(source, name);
  }

  struct ElementColumns {
    std::array<LocalIndex, max_nodes> column{};
    std::size_t count = 0;
  };
  const ElementColumns& of(const Sample& sample) {
    return elements_[static_cast<std::size_t>(element_table_.slot(sample.source_owner, sample.source_item))];
  }
  LocalIndex of_slot(std::size_t slot) const { return from_interpolation_[slot]; }
  bool by_node() const { return by_node_; }
  std::size_t size() const { return size_; }
  ExchangePlan gather;

 private:
  /// The distinct source elements that samples lie in, and where their nodes are.
  void find_elements(const Side& source, const TargetSamples& samples, const std::string& name) {
    for (const Sample& s : samples.samples) element_table_.mark(s.source_owner, s.source_item);
    element_table_.number();
    elements_.resize(element_table_.owners().size());
    if (!by_node_) return;
    nodes_ = std::make_unique<PlacedNodes>(source.mesh, source.nodes, element_table_, name + ".elements");
  }

  /// Where the items of the interpolation are kept.
  void find_owners(const Side& source, const RowMap& interpolation) {
    std::vector<LocalIndex> here(source.items.ids.size());
    std::iota(here.begin(), here.end(), LocalIndex{0});
    owner_ = interpolation.gathered(source.items.owners);
    index_ = interpolation.gathered(std::span<const LocalIndex>(here));
  }

  void number(const Side& source, const std::string& name) {
    SlotTable table;
    for (std::size_t s = 0; s < owner_.size(); ++s) table.mark(owner_[s], index_[s]);
    for (std::size_t k = 0; by_node_ && k < nodes_->elements(); ++k) {
      const PlacedNodes::Nodes nodes = nodes_->element(k);
      for (std::size_t a = 0; a < nodes.count; ++a) table.mark(nodes.owner[a], nodes.at_owner[a]);
    }
    if (!by_node_)
      for (std::size_t k = 0; k < elements_.size(); ++k)
        table.mark(element_table_.owners()[k], element_table_.indices()[k]);
    table.number();
    for (std::size_t s = 0; s < owner_.size(); ++s) from_interpolation_.push_back(table.slot(owner_[s], index_[s]));
    for (std::size_t k = 0; k < elements_.size(); ++k) {
      elements_[k].count = by_node_ ? nodes_->element(k).count : 1;
      for (std::size_t a = 0; a < elements_[k].count; ++a)
        elements_[k].column[a] = by_node_ ? table.slot(nodes_->element(k).owner[a], nodes_->element(k).at_owner[a])
                                          : table.slot(element_table_.owners()[k], element_table_.indices()[k]);
    }
    nodes_.reset();
    size_ = table.owners().size();
    std::vector<LocalIndex> into(size_);
    std::iota(into.begin(), into.end(), LocalIndex{0});
    gather = ExchangePlan::from_owners(source.mesh.comm, table.owners(), table.indices(), into, name + ".gather");
  }

  bool by_node_;
  SlotTable element_table_;
  std::unique_ptr<PlacedNodes> nodes_;
  std::vector<ElementColumns> elements_;
  std::vector<int> owner_;
  std::vector<LocalIndex> index_, from_interpolation_;
  std::size_t size_ = 0;
};

/// One row at a time, over all columns.
class Accumulator {
 public:
  explicit Accumulator(std::size_t columns) : place_(columns, no_index) {}
  void add(LocalIndex column, double value) {
    LocalIndex& place = place_[static_cast<std::size_t>(column)];
    if (place == no_index) {
      place = static_cast<LocalIndex>(columns_.size());
      columns_.push_back(column), values_.push_back(value);
    } else {
      values_[static_cast<std::size_t>(place)] += value;
    }
  }
  /// Appends the row and begins the next one.
  void close(SparseRows<double>& rows, double scale) {
    for (const LocalIndex column : columns_) place_[static_cast<std::size_t>(column)] = no_index;
    rows.column.insert(rows.column.end(), columns_.begin(), columns_.end());
    for (const double value : values_) rows.value.push_back(scale * value);
    rows.begin.push_back(static_cast<std::int64_t>(rows.column.size()));
    columns_.clear(), values_.clear();
  }

 private:
  std::vector<LocalIndex> place_, columns_;
  std::vector<double> values_;
};

class Assembler {
 public:
  Assembler(const Side& source, const Side& target, const RowMap& interpolation, const TargetSamples& samples,
            SampleTables& tables, const std::string& name)
      : target_(target),
        interpolation_(interpolation),
        samples_(samples),
        tables_(tables),
        columns_(source, interpolation, samples, name),
        row_(columns_.size()) {}

  ProjectionRows to_nodes(const NodeElements& around, const MassMatrix& mass) {
    ProjectionRows result = begin();
    std::vector<double> of_node(static_cast<std::size_t>(target_.mesh.nodes()), 0.0);
    const std::vector<std::span<const LocalIndex>> nodes_of = connectivity();
    for (std::size_t k = 0; k < target_.mesh.owned_nodes.size(); ++k) {
      const LocalIndex i = target_.mesh.owned_nodes[k];
      add_interpolation(i, 1.0);
      row_.close(result.values, 1.0);
      for (const NodeElements::Entry& at : around.around(i)) {
        const auto nodes = nodes_of[static_cast<std::size_t>(at.element)];
        std::array<double, max_linear_nodes> part{};
        add_samples(at.element, [&](const Sample& s) {
          const double w = s.weight * s.target_value[static_cast<std::size_t>(at.place)];
          for (std::size_t b = 0; b < max_linear_nodes; ++b) part[b] += w * s.target_value[b];
          return w;
        });
        for (std::size_t b = 0; b < nodes.size(); ++b) of_node[static_cast<std::size_t>(nodes[b])] += part[b];
      }
      for (std::size_t m = mass.rows().first(k); m < mass.rows().last(k); ++m) {
        double& c = of_node[static_cast<std::size_t>(mass.rows().column[m])];
        if (c != 0) add_interpolation(mass.rows().column[m], -c);
        c = 0;
      }
      row_.close(result.residual, 1.0);
    }
    return result;
  }

  /// The mean over an element: that of the interpolated nodes, exactly, and of what the samples differ from it.
  ProjectionRows to_elements(std::span<const double> volumes) {
    ProjectionRows result = begin();
    for_each_element(target_.mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
      const Corners corners = corners_of(block, e, target_.coordinates);
      const auto nodes = block.nodes(e);
      std::array<double, max_nodes> part{};
      for (const TabulatedPoint& point : quadrature_points_of(block.kind)) {
        const double w = point.weight * measure(point, block.kind, corners);
        for (std::size_t b = 0; b < nodes.size(); ++b) part[b] += w * point.value[b];
      }
      add_samples(item, [&](const Sample& s) {
        for (std::size_t b = 0; b < max_linear_nodes; ++b) part[b] -= s.weight * s.target_value[b];
        return s.weight;
      });
      for (std::size_t b = 0; b < nodes.size(); ++b) add_interpolation(nodes[b], part[b]);
      const double volume = volumes[static_cast<std::size_t>(item)];
      row_.close(result.values, volume > 0 ? 1 / volume : 0.0);
    });
    return result;
  }

 private:
  ProjectionRows begin() {
    ProjectionRows result;
    result.gather = columns_.gather;
    result.columns = columns_.size();
    return result;
  }

  std::vector<std::span<const LocalIndex>> connectivity() const {
    std::vector<std::span<const LocalIndex>> result;
    result.reserve(static_cast<std::size_t>(target_.mesh.elements()));
    for_each_element(target_.mesh,
                     [&](LocalIndex, const ElementBlock& block, LocalIndex e) { result.push_back(block.nodes(e)); });
    return result;
  }

  const std::vector<TabulatedPoint>& quadrature_points_of(ElementKind kind) {
    std::vector<TabulatedPoint>& rule = rules_[static_cast<std::size_t>(kind)];
    if (rule.empty()) rule = quadrature_points(kind);
    return rule;
  }

  void add_interpolation(LocalIndex node, double factor) {
    interpolation_.for_each_term(static_cast<std::size_t>(node), [&](std::size_t slot, double weight) {
      if (weight != 0) row_.add(columns_.of_slot(slot), factor * weight);
    });
  }

  /// Adds sum_q weight(q) f(x_q) over the samples in an element.
  template <typename Weight>
  void add_samples(LocalIndex element, Weight&& weight) {
    const std::span<const Sample> samples = samples_.in(element);
    for (std::size_t q = 0; q < samples.size();) {
      std::size_t end = q + 1;
      while (end < samples.size() && samples[end].source_element == samples[q].source_element) ++end;
      add_group(samples.subspan(q, end - q), weight);
      q = end;
    }
  }

  /// The same over the samples in one element of the target that are also in one of the source.
  template <typename Weight>
  void add_group(std::span<const Sample> samples, Weight&& weight) {
    const Columns::ElementColumns& columns = columns_.of(samples.front());
    if (!columns_.by_node()) {
      double sum = 0;
      for (const Sample& s : samples) sum += weight(s);
      row_.add(columns.column[0], sum);
    } else if (columns.count <= max_linear_nodes) {
      add_nodes<max_linear_nodes>(samples, columns, weight);
    } else {
      add_nodes<max_nodes>(samples, columns, weight);
    }
  }

  /// `width`: known to the compiler, at least as many as there are nodes.
  template <std::size_t width, typename Weight>
  void add_nodes(std::span<const Sample> samples, const Columns::ElementColumns& columns, Weight&& weight) {
    const Sample& first = samples.front();
    const std::span<const double> values = tables_.values(static_cast<ElementKind>(first.kind), first.cells);
    std::array<double, width> sum{};
    for (const Sample& s : samples) {
      const double w = weight(s);
      const double* const value = values.data() + std::size_t{s.point} * width;
      for (std::size_t a = 0; a < width; ++a) sum[a] += w * value[a];
    }
    for (std::size_t a = 0; a < columns.count; ++a) row_.add(columns.column[a], sum[a]);
  }

  const Side& target_;
  const RowMap& interpolation_;
  const TargetSamples& samples_;
  SampleTables& tables_;
  Columns columns_;
  Accumulator row_;
  std::array<std::vector<TabulatedPoint>, element_kinds> rules_;
};

}  // namespace

ProjectionRows projection_rows(const Side& source, const Side& target, const RowMap& interpolation,
                               const TargetSamples& samples, SampleTables& tables, const NodeElements& around,
                               const MassMatrix& mass, std::span<const double> volumes, const std::string& name) {
  Assembler assembler(source, target, interpolation, samples, tables, name);
  return target.location == Location::node ? assembler.to_nodes(around, mass) : assembler.to_elements(volumes);
}

}  // namespace tenon::transfer
