/* Reads a problem with Debian's FCLIB, the library that Siconos reads files by, and prints Siconos'
   own error of its reference. (FCLIB reads an answer from the problem's own file only.) Nothing
   here is Ballast's.

     read_by_siconos PROBLEM.hdf5 REFERENCE */
#include <fclib.h>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <math.h>
#include <siconos/numerics/GlobalFrictionContactProblem.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/gfc3d_compute_error.h>
#include <stdio.h>
#include <stdlib.h>

/* FCLIB: nz = -1 compressed columns, -2 compressed rows, else triplets. */
static NumericsMatrix* dense(const struct fclib_matrix* a) {
  double* x = calloc((size_t)a->m * a->n, sizeof(double));
  const int lines = a->nz == -1 ? a->n : a->m;
  if (a->nz >= 0)
    for (int k = 0; k < a->nz; ++k) x[a->i[k] + (size_t)a->m * a->p[k]] += a->x[k];
  else
    for (int line = 0; line < lines; ++line)
      for (int k = a->p[line]; k < a->p[line + 1]; ++k) {
        const int row = a->nz == -1 ? a->i[k] : line, column = a->nz == -1 ? line : a->i[k];
        x[row + (size_t)a->m * column] = a->x[k];
      }
  return NM_create_from_data(NM_DENSE, a->m, a->n, x);
}

static double norm(const double* x, int n) {
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += x[k] * x[k];
  return sqrt(sum);
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  struct fclib_global* read = fclib_read_global(argv[1]);
  const hid_t answer = H5Fopen(argv[2], H5F_ACC_RDONLY, H5P_DEFAULT);
  if (!read || answer < 0) return 1;
  double *r = calloc(read->H->n, sizeof(double)), *u = calloc(read->H->n, sizeof(double)),
         *v = calloc(read->H->m, sizeof(double));
  H5LTread_dataset_double(answer, "/solution/r", r);
  H5LTread_dataset_double(answer, "/solution/v", v);
  GlobalFrictionContactProblem* problem = globalFrictionContactProblem_new();
  problem->dimension = read->spacedim;
  problem->numberOfContacts = read->H->n / read->spacedim;
  problem->M = dense(read->M);
  problem->H = dense(read->H);
  problem->q = read->f;
  problem->b = read->w;
  problem->mu = read->mu;
  SolverOptions* options = solver_options_create(SICONOS_GLOBAL_FRICTION_3D_NSGS);
  double error = NAN;
  gfc3d_compute_error(problem, r, u, v, 1e-6, options, norm(read->f, read->M->m),
                      norm(read->w, read->H->n), &error);
  printf("contacts %d error %.3e\n", problem->numberOfContacts, error);
  return error < 1e-6 ? 0 : 1;
}
