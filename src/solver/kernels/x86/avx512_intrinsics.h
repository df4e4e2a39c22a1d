// SPDX-License-Identifier: MIT
#pragma once

// GCC 12 finds values uninitialised that its own header leaves so, where no bit of them is used.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>
#pragma GCC diagnostic pop
