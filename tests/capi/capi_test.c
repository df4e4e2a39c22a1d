/* SPDX-License-Identifier: MIT */
/* The C interface, from C. */
#include <stdio.h>

#include "check.h"

int main(void) {
  test_errors();
  test_contacts();
  test_joints();
  test_state();
  test_recording();
  test_session();
  test_golden();
  printf("%d failures\n", failures());
  return failures() == 0 ? 0 : 1;
}
