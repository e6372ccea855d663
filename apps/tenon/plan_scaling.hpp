// SPDX-License-Identifier: BSD-3-Clause
// `tenon plan --ranks`: what a step would take on other numbers of ranks and on other machines.
#pragma once

#include "apps/tenon/build_simulation.hpp"
#include "apps/tenon/commands.hpp"
#include "apps/tenon/trial_steps.hpp"

namespace tenon {

/// Of the steps to be measured. Throws Error(usage).
TrialOptions trial_options(const PlanArguments& arguments);

/// Collective. Refuses what could not be planned, before anything is read. Throws Error(usage).
void check_plan(const Communicator& comm, const PlanArguments& arguments);

/// On one rank, after the trial. Prints the tables and writes the CSV that is asked for. Throws Error.
void plan_scaling(BuiltScene& built, const PlanArguments& arguments, const Trial& trial);

/// Collective. What each phase took, per step.
void print_trial(Log& log, const Communicator& comm, const Trial& trial);

}  // namespace tenon
