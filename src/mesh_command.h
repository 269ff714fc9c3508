/* The command "rhegma mesh", which makes and shows mesh files; no MPI. */
#ifndef RG_MESH_COMMAND_H
#define RG_MESH_COMMAND_H

#include <stdbool.h>

#include "case/expr.h"
#include "mesh/import/import.h"

typedef struct {
    const char *input, *output;
    const char *material; /* --case: a case file with the material for --info */
    rg_import_how how;    /* --scale, --unit, --merge, --split */
    const char *unit;     /* --unit; NULL: none */
    rg_expr *size;        /* --size; NULL: none */
    double curvature;     /* --curvature; 0: none */
    bool info;
    bool improve;          /* --improve */
    int tile;              /* --tile; 0: RG_TILE */
    bool apart;            /* --apart */
    const char *crack;     /* --crack; NULL: none */
    const char *partition; /* --partition: numbers of ranks, separated by commas */
    int overrides;
    const char **override; /* --set */
} rg_mesh_arguments;

/* Reads "IN -o OUT.h5 [--unit U]" and so on from argv[first] on. Ends the run with a message and RG_USAGE if
 * something is wrong. */
rg_mesh_arguments rg_mesh_arguments_read(int argc, char **argv, int first);

/* Runs "rhegma mesh ..." with argv[1] = "mesh"; returns the exit status. Inputs that are neither case nor
 * mesh file go to the program rhegma-mesh beside this one, which is built where Gmsh is there. */
int rg_mesh_command(int argc, char **argv);

/* Prints how to use it; returns RG_OK. */
int rg_mesh_help(void);

/* Sorts, connects and checks an imported mesh, tells of what is odd about it, improves it if that was asked
 * for, and writes it. */
void rg_mesh_finish(rg_mesh *mesh, const rg_mesh_arguments *a);

#endif
