/* The command "rhegma materials", which prints the solids that a case may name; no MPI. */
#ifndef RG_MATERIALS_COMMAND_H
#define RG_MATERIALS_COMMAND_H

/* Runs "rhegma materials ..." with argv[1] = "materials"; returns the exit status. */
int rg_materials_command(int argc, char **argv);

#endif
