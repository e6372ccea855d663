// SPDX-License-Identifier: BSD-3-Clause
// Contact between and within the surfaces of any components: found and enforced in decompositions of its own.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/contact/candidate_search.hpp"
#include "components/contact/contact_options.hpp"
#include "components/contact/enforcement.hpp"
#include "components/contact/rigid_surface.hpp"
#include "components/contact/working_set.hpp"
#include "components/contact_geometry/choose_touches.hpp"
#include "components/contact_geometry/edge_touch.hpp"
#include "framework/simulation/interaction.hpp"

namespace tenon {

/// Surfaces may not enter each other: at the end of every step every gap is closed at most. Impulses on the nodes are
/// explicit Lagrange multipliers [CTB91] that depend on masses only, so there is no stiffness to choose, and
/// constraints never lower the stable step of the parties. What a node loses when it hits is kept as contact energy and
/// given back when it leaves: waves are reflected as the continuum does it, whatever the size of the elements.
///
/// A step (of the parties together):
///   search     only when a node has used up its skin: boxes of nodes, faces and sharp edges in the decomposition of
///   the
///              search; candidate pairs go to the decomposition of the enforcement
///   gather     places and velocities of the nodes that have candidates
///   touch      which pairs can meet in this step, and where (contact_geometry)
///   solve      impulses, by iteration; velocities of shared nodes go round once per iteration
///   return     impulses to the owners of the nodes
/// Everything is collective unless it says local; results are the same bits on any number of ranks, and whenever a
/// search or a partition is renewed.
class Contact final : public Interaction {
 public:
  /// Collective. Throws Error(usage) for names that no surface has, and where a component can touch nothing.
  Contact(std::string name, const Communicator& comm, std::vector<Component*> parties, ContactOptions options);
  ~Contact() override;

  const std::vector<Component*>& parties() const override { return components_; }
  void initialize() override;
  void prepare(double time, double dt) override;
  void act(double time, double dt) override;

  void energies(std::vector<EnergyTerm>& terms) override;
  std::vector<std::pair<std::string, ExactSum>> amounts() override;
  std::vector<HistoryValue> history_values() override;
  std::vector<SkipCount> skips() const override;
  std::vector<std::string> warnings() const override { return warnings_; }
  std::vector<std::string> report() override;

  void save(CheckpointWriter& file) override;
  void load(const CheckpointReader& file) override;
  std::int64_t memory() const override;

  /// Residuals of the impulses of the last step, relative to the sum of their sizes: linear, and angular about the
  /// origin of coordinates (relative to sizes times the distance between the farthest of them). Collective.
  std::array<double, 2> momentum_errors() const;
  /// Counted work of this rank since the start: box tests of searches; constraint visits of enforcement.
  std::int64_t search_work() const { return search_work_; }
  std::int64_t enforcement_work() const { return enforcement_work_; }
  std::int64_t searches() const { return searches_; }
  std::int64_t steps() const { return steps_; }
  /// Local, for plans: what is searched, and what is enforced.
  const contact::ContactSurfaces& surfaces() const { return surfaces_; }
  const contact::CandidateSearch& candidates() const { return search_; }
  const contact::WorkingSet& working_set() const { return set_; }
  /// Of enforcement, since the start.
  std::int64_t iterations() const { return iterations_total_; }
  std::int64_t looks() const { return looks_; }        // at pairs
  std::int64_t pressing() const { return pressing_; }  // pairs, summed over steps

 private:
  using Constraint = contact::Constraint;
  using PairKey = contact::PairKey;
  using PairMemory = contact::PairMemory;

  static constexpr std::int64_t kept_overlap = 9;  // kind of a row of the checkpoint

  // Set-up.
  void read_pairs();
  std::int32_t find_surface(const std::string& name) const;
  bool are_balls(std::int32_t first, std::int32_t second) const;
  std::string surface_name(std::int32_t surface) const;
  void settle_overlaps();
  void find_overlaps();
  void list_overlaps();
  void push_apart();
  void keep_overlaps();
  void judge_buried();
  // Search.
  void search(double time, double dt);
  void renew(double time, double dt);
  double used_by_rigid(double time, double dt) const;
  void add_rigid_pairs(double time, double dt, std::vector<contact::PairRecord>& extra);
  bool admit(contact::PairRecord& pair) const;
  void limit_clearances();
  void let_rest();
  void watch_nodes();
  // A step.
  void find_impulses(double time, double dt);
  double used_by_thrown(double time, double dt) const;
  Vec3 thrown(std::size_t surface) const;
  void expect_thrown(double dt);
  void gather(double time, double dt);
  void find_constraints(double time, double dt);
  bool find_more(double time, double dt);
  bool is_moved(std::size_t begin, std::size_t end) const;
  void make_groups();
  void touch_pairs(double time, double dt);
  double fastest(std::span<const Vec3> velocity, double time, double dt) const;
  double near_of(const contact::WorkingPair& pair) const;
  double distance_to_face(const contact::WorkingPair& pair, const Vec3& x, const contact::FaceShape& face) const;
  void let_sleep(std::size_t pair, double apart, double dt);
  double least_distance(const contact::WorkingPair& pair) const;
  void touch_faces(std::size_t begin, std::size_t end, double dt);
  void touch_edges(std::size_t pair, double dt);
  void touch_rigid(std::size_t pair, double time, double dt);
  void touch_balls(std::size_t pair, double dt);
  void add_constraint(std::size_t pair, const contact::Touch* touch, const contact::EdgeTouch* edges,
                      const contact::RigidTouch* rigid, double dt);
  void hand_over(std::size_t begin, std::size_t end, std::size_t first_constraint);
  bool solve(double time, double dt, double kick, bool last);
  void limit_removal(Constraint& constraint, double dt) const;
  void release();
  void book(double dt, double kick);
  void send_back();
  void fill_fields(double kick);
  void clear_fields();
  void move_rigid(double time, double dt);
  std::int32_t party_bodies() const;
  struct NodeResult {
    Vec3 force{}, slip{};
    double gap = 0, status = 0, pressure = 0, heat = 0;
  };
  double first_share(const contact::WorkingPair& pair) const;
  NodeResult result_of(std::size_t node, double kick) const;

  Communicator comm_;
  std::vector<Component*> components_;
  std::vector<ContactParty*> parties_;
  ContactOptions options_;
  std::vector<contact::MovingSurface> rigid_;
  contact::ContactSurfaces surfaces_;
  contact::CandidateSearch search_;
  contact::WorkingSet set_;
  contact::Enforcement enforcement_;

  /// What holds between two surfaces (blocks first, then rigid ones), by first * surfaces + second.
  struct Rule {
    bool ignore = false, tied = false;
    CoulombFriction friction;
  };
  std::int32_t surface_count_ = 0;
  std::vector<Rule> rules_;

  std::map<GlobalId, double> kept_;  // m: overlap that nodes of this rank were given

  double used_before_ = 0;
  double used_ = 0;                 // of the skins, after the last step
  std::vector<Vec3> rigid_sought_;  // shifts of rigid surfaces when sought, m
  double rigid_skin_ = 0;           // m, which they may move beside the common motion
  double rigid_reserve_ = 0;        // m, of it for what contact is about to do
  double widening_ = 1;
  int narrow_ = 0;  // searches until skins may be widened again
  bool started_ = false;

  // Of a step.
  std::vector<contact::NodeState> home_state_, state_;
  std::vector<contact::CandidateSearch::Sought> sought_;              // of the nodes of the set
  std::vector<std::pair<std::size_t, contact::PairMemory>> changed_;  // memories of pairs before this step moved them
  std::vector<double> given_up_;                                      // J, of memories that no pair took over
  std::vector<Vec3> end_;                                             // predicted places, m
  std::vector<Vec3> former_;                                          // velocities of before the kick, m/s
  std::vector<contact::Body> former_bodies_;
  std::vector<contact::Body> bodies_;     // of the parties, then free rigid surfaces
  std::vector<std::int32_t> first_body_;  // of each party; then of the rigid surfaces
  std::vector<Constraint> constraints_;
  std::vector<std::int32_t> constraint_of_pair_;
  std::vector<contact::Enforcement::Release> released_;
  std::vector<Vec3> solved_;  // velocities by contact before anything is released, m/s
  std::vector<contact::Body> solved_bodies_, pushed_bodies_;
  std::vector<Vec3> slid_;    // m, in this step, per constraint
  std::vector<double> heat_;  // J, likewise
  std::vector<contact::Touch> touches_;
  std::vector<std::array<GlobalId, 4>> touch_nodes_;
  std::vector<GlobalId> touch_ids_;
  std::vector<std::size_t> touch_pairs_;
  struct Group {
    std::size_t begin, end;
  };
  std::vector<Group> groups_;              // of pairs
  std::vector<double> wake_, group_wake_;  // m: at which way_ a pair may touch; 0: it may now
  double way_ = 0, fastest_ = 0;           // m, twice the longest way of a node since the search; m/s
  std::vector<Vec3> predicted_;            // velocities by all other forces, m/s
  std::vector<char> moved_;                // nodes of the set, by contact
  bool remembers_ = false;                 // some pair of the node in hand has a memory to hand over
  bool settling_ = false;                  // before the first step: everything stands
  bool again_ = false;                     // ways are looked at once more
  bool any_constraint_ = false;
  struct Filled {
    std::int32_t party;
    LocalIndex node;
  };
  std::vector<Filled> filled_, formerly_filled_;  // nodes with fields of this step and of the one before
  std::vector<Vec3> home_impulse_;
  std::vector<NodeResult> results_, home_results_;

  // Books: of pairs that this rank reports.
  ExactSum dissipated_, friction_, rigid_work_;  // J, since the start
  struct PairTotals {
    std::int32_t first, second;
    std::array<ExactSum, 3> force, impulse;  // on the first, N of the last step and N s
    ExactSum friction_work;                  // J
  };
  std::vector<PairTotals> totals_;
  std::int64_t active_ = 0;
  int iterations_ = 0;

  std::int64_t steps_ = 0, searches_ = 0, idle_steps_ = 0, iterations_total_ = 0;
  std::int64_t search_work_ = 0, enforcement_work_ = 0;
  std::int64_t looks_ = 0, pressing_ = 0;
  std::vector<std::string> warnings_;
  std::vector<std::pair<PairKey, PairMemory>> restored_;

  struct Phases {
    PhaseTimer *check, *search, *share, *touch, *solve, *exchange;
  } phases_{};
};

}  // namespace tenon
