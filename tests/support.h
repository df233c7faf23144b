/* What the test programs share: cmocka with its headers, the folder of shared data, scratch
 * folders. */
#ifndef GONIO_TEST_SUPPORT_H
#define GONIO_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gonio/basis.h>
#include <gonio/context.h>
#include <gonio/material.h>

/* A test's main is one function of the program gonio-tests: see main.c. */
#ifdef GONIO_TEST
int GONIO_TEST(void);
#define main GONIO_TEST
#endif

/* The folder with measured data and reference numbers, from $GONIO_SHARED; NULL if it is not there.
 */
const char *support_shared(void);

/* Skips the running test, saying so, where that folder is not there. */
void support_need_shared(void);

/* Whether fewer repeats and smaller grids will do, as everything is run by another build:
 * $GONIO_TESTS is "small". */
bool support_small(void);

/* The names of the MERL database's materials. */
enum { SUPPORT_MERL = 100 };
extern const char *const support_merl[SUPPORT_MERL];

/* A material of a file, read whole into memory, for tests that read it several times: 35 MB. */
gonio_material *support_load(gonio_context *context, const char *path);

/* A context that keeps the last error message in support_message(). */
gonio_context *support_context(void);
const char *support_message(void);

/* V of a basis, [rows][components]; released with free(). */
double *support_vectors(const gonio_basis *basis);

/* A new folder for a test's files; support_remove deletes it with its contents. */
char *support_folder(void);
void support_remove(char *folder);

#endif
