// SPDX-License-Identifier: MIT
// A game's own arithmetic on double, in the shapes that compilers like to fuse: turning a vector, a product
// of complex numbers, sums of products, in loops and alone.
#include "client_double.h"

Pair turned(Pair v, Pair by) { return {v.x * by.x - v.y * by.y, v.x * by.y + v.y * by.x}; }

void turnAll(Pair* vectors, int count, Pair by) {
  for (int i = 0; i < count; ++i) vectors[i] = turned(vectors[i], by);
}

double sum(const double* a, const double* b, int count) {
  double total = 0;
  for (int i = 0; i < count; ++i) total += a[i] * b[i];
  return total;
}

void axpy(double* y, const double* x, double a, int count) {
  for (int i = 0; i < count; ++i) y[i] = y[i] + a * x[i];
}

void alternate(double* out, const double* a, const double* b, const double* c) {
  out[0] = a[0] * b[0] - c[0];
  out[1] = a[1] * b[1] + c[1];
  out[2] = a[2] * b[2] - c[2];
  out[3] = a[3] * b[3] + c[3];
}
