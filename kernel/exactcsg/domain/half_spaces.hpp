// SPDX-License-Identifier: Apache-2.0
#pragma once

// Every half-space of the library, one line for each file.

#include "exactcsg/domain/ball.hpp"
#include "exactcsg/domain/cone.hpp"
#include "exactcsg/domain/cylinder.hpp"
#include "exactcsg/domain/ellipsoid.hpp"
#include "exactcsg/domain/line.hpp"
#include "exactcsg/domain/plane.hpp"
#include "exactcsg/domain/torus.hpp"
