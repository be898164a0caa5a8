/* Siconos' projected Gauss-Seidel as a program for `ballast compare --external`, without any code
   of Ballast's. It stops on what Siconos prints, so it is asked with --measure fclib.

     cc siconos_nsgs.c -o siconos_nsgs $(pkg-config --cflags --libs hdf5) -lhdf5_hl \
       -lsiconos_numerics -I/usr/include/siconos -I/usr/include/siconos/numerics
     ballast compare known:contacts=50 --measure fclib --external c_nsgs=./siconos_nsgs */
#include <hdf5.h>
#include <hdf5_hl.h>
#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { solved = 0, iteration_limit = 1, unsupported = 5, most_contacts = 1500 };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

/* All of a dataset, as doubles or as ints. */
static void* read_all(hid_t file, const char* name, hid_t type, hsize_t* count) {
  hsize_t size = 0;
  if (H5LTget_dataset_info(file, name, &size, NULL, NULL) < 0) {
    fprintf(stderr, "%s: no such dataset\n", name);
    exit(1);
  }
  void* values = malloc(8 * (size + 1));
  H5LTread_dataset(file, name, type, values);
  if (count) *count = size;
  return values;
}

static double number(hid_t file, const char* name) {
  double* value = read_all(file, name, H5T_NATIVE_DOUBLE, NULL);
  const double copy = *value;
  free(value);
  return copy;
}

static void write_int(hid_t file, const char* name, int value) {
  const hsize_t one = 1;
  H5LTmake_dataset_int(file, name, 1, &one, &value);
}
static void write_doubles(hid_t file, const char* name, const double* values, hsize_t count) {
  H5LTmake_dataset_double(file, name, 1, &count, values);
}

int main(int argc, char** argv) {
  if (argc != 3) return fprintf(stderr, "usage: siconos_nsgs PROBLEM ANSWER\n"), 2;
  const hid_t in = H5Fopen(argv[1], H5F_ACC_RDONLY, H5P_DEFAULT);
  if (in < 0) return 1;
  if (number(in, "/ballast_request/protocol") != 1) return fprintf(stderr, "protocol\n"), 1;

  /* W comes by compressed rows (nz = -2) or columns (-1); Siconos' dense W by columns. */
  hsize_t rows, contacts;
  double* q = read_all(in, "/fclib_local/vectors/q", H5T_NATIVE_DOUBLE, &rows);
  double* mu = read_all(in, "/fclib_local/vectors/mu", H5T_NATIVE_DOUBLE, &contacts);
  double* r = read_all(in, "/ballast_request/start", H5T_NATIVE_DOUBLE, NULL);
  double* x = read_all(in, "/fclib_local/W/x", H5T_NATIVE_DOUBLE, NULL);
  int* p = read_all(in, "/fclib_local/W/p", H5T_NATIVE_INT, NULL);
  int* i = read_all(in, "/fclib_local/W/i", H5T_NATIVE_INT, NULL);
  const int by_rows = number(in, "/fclib_local/W/nz") == -2;
  const double tolerance = number(in, "/ballast_request/fclib_tolerance");
  int status = unsupported, iterations = 0;
  double residual = 0.0, seconds = 0.0;
  if (tolerance > 0.0 && contacts <= most_contacts) {
    double* dense = calloc(rows * rows, sizeof(double));
    for (hsize_t line = 0; line < rows; ++line)
      for (int k = p[line]; k < p[line + 1]; ++k)
        dense[by_rows ? line + rows * i[k] : i[k] + rows * line] = x[k];
    NumericsMatrix* w = NM_create_from_data(NM_DENSE, rows, rows, dense);
    FrictionContactProblem* problem = frictionContactProblem_new_with_data(3, contacts, w, q, mu);
    SolverOptions* options = solver_options_create(SICONOS_FRICTION_3D_NSGS);
    options->dparam[SICONOS_DPARAM_TOL] = tolerance;
    const double most = number(in, "/ballast_request/max_iterations");
    options->iparam[SICONOS_IPARAM_MAX_ITER] = most < 1e6 ? most : 1e6;
    double* u = calloc(rows, sizeof(double));
    const double begin = now();
    status = fc3d_driver(problem, r, u, options) == 0 ? solved : iteration_limit;
    seconds = now() - begin;
    iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];
    residual = options->dparam[SICONOS_DPARAM_RESIDU];
  }

  const hid_t out = H5Fcreate(argv[2], H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Gclose(H5Gcreate2(out, "/ballast_answer", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  write_int(out, "/ballast_answer/protocol", 1);
  write_int(out, "/ballast_answer/id", number(in, "/ballast_request/id"));
  write_int(out, "/ballast_answer/status", status);
  write_int(out, "/ballast_answer/iterations", iterations);
  write_doubles(out, "/ballast_answer/residual", &residual, 1);
  write_doubles(out, "/ballast_answer/seconds", &seconds, 1);
  write_doubles(out, "/ballast_answer/r", r, rows);
  return H5Fclose(out) < 0;
}
