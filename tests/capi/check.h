/* SPDX-License-Identifier: MIT */
#ifndef SAMESTEP_TESTS_CAPI_CHECK_H
#define SAMESTEP_TESTS_CAPI_CHECK_H

#include <samestep/c/samestep.h>

/* Notes a claim that does not hold. */
void check(int holds, const char* claim, int line);
/* Notes a call that was not answered as wanted. */
void check_status(samestep_status found, samestep_status wanted, const char* about, int line);
/* Notes two numbers that should be the same. */
void check_equal(uint64_t found, uint64_t wanted, const char* about, int line);
int failures(void);
/* Says what is tested. */
void begin(const char* name);

/* The scalars of this build; answers how many. */
int scalars(int32_t found[2]);
/* A world of a scalar with default settings and gravity of 10 m/s^2. */
samestep_world* make_world(int32_t scalar);
uint64_t hash_of(const samestep_world* world);
/* A body at a place, with a box of 1 m of 1 kg/m^2 unless it is static. */
samestep_body_id add_box(samestep_world* world, int32_t type, double x, double y, samestep_shape_id* shape);
void steps(samestep_world* world, int count);

void test_errors(void);
void test_contacts(void);
void test_joints(void);
void test_state(void);
void test_recording(void);
void test_session(void);
void test_golden(void);

#endif
