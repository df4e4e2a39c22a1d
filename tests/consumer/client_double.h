// SPDX-License-Identifier: MIT
// A game's own arithmetic on double: see client_double.cpp.
#pragma once

struct Pair {
  double x;
  double y;
};

Pair turned(Pair v, Pair by);
void turnAll(Pair* vectors, int count, Pair by);
double sum(const double* a, const double* b, int count);
void axpy(double* y, const double* x, double a, int count);
void alternate(double* out, const double* a, const double* b, const double* c);
