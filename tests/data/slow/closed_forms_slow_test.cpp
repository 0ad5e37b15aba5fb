// SPDX-License-Identifier: GPL-3.0-or-later
// The same as closed_forms_test.cpp for models that take longer.

#include "data/closed_forms.hpp"

namespace exactcsg::test {
namespace {

TEST_P(ClosedForm, AgreesWithTheDerivedValues) { compare_with_closed_form(GetParam()); }

INSTANTIATE_TEST_SUITE_P(LargeModels, ClosedForm, testing::ValuesIn(model_names(true)), name_of);

}  // namespace
}  // namespace exactcsg::test
