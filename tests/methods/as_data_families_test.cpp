// SPDX-License-Identifier: BSL-1.0
// Members of families of drifts and kicks take, by their types, the steps of their tables.
#include <boost/test/unit_test.hpp>

#include "../laws/data_laws.hpp"

using namespace nysalt;
using namespace nysalt::test;

using members = members_of<families>;

BOOST_AUTO_TEST_CASE_TEMPLATE(a_type_steps_as_its_table, M, members) { try_as_data<M, one_system>(); }
