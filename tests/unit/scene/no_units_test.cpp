// SPDX-License-Identifier: BSD-3-Clause
// Without the units database every quantity with a unit is refused with the name of the package; a program of its own,
// because the database is read once.
#include <gtest/gtest.h>

#include <cstdlib>

#include "framework/base/error.hpp"
#include "framework/scene/schema.hpp"

namespace tenon::scene {
namespace {

TEST(UnitsDatabase, AMissingOneIsNamedWithItsPackage) {
  ASSERT_EQ(setenv("UDUNITS2_XML_PATH", "/nowhere/udunits2.xml", 1), 0);
  try {
    parse_quantity("5 mm", "m");
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::file);
    EXPECT_NE(std::string(error.what()).find("install the package libudunits2-data"), std::string::npos)
        << error.what();
  }
  ASSERT_EQ(unsetenv("UDUNITS2_XML_PATH"), 0);
  EXPECT_EQ(parse_quantity("5 mm", "m"), 5e-3);
}

}  // namespace
}  // namespace tenon::scene
