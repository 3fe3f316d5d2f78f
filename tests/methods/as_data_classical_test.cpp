// SPDX-License-Identifier: BSL-1.0
// Classical methods by their types take the steps of their tables.
#include <boost/test/unit_test.hpp>

#include "../laws/data_laws.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(a_type_steps_as_its_table, M, classical_types) { try_as_data<M, one_system>(); }
