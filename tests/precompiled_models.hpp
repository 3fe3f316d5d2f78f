// SPDX-License-Identifier: BSL-1.0
// What most tests include, to be precompiled, and models of systems that many of them use: those are
// compiled once (laws/compiled_models.cpp).
#pragma once

#include <boost/test/unit_test.hpp>

#include "../cmake/precompiled.hpp"
#include "laws/compiled_models.hpp"
