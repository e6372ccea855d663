// SPDX-License-Identifier: BSD-3-Clause
// The block `contact` of a scene.
#pragma once

#include "components/contact/contact_options.hpp"
#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

scene::Schema contact_schema();
/// Complaints go to the diagnostics; what is read then is of no use.
ContactOptions read_contact(const scene::Value& block, scene::Diagnostics& diagnostics);

}  // namespace tenon
