/* The command "rhegma material", which compiles a material of the user's into a library; no MPI. */
#ifndef RG_MATERIAL_COMMAND_H
#define RG_MATERIAL_COMMAND_H

/* Runs "rhegma material ..." with argv[1] = "material"; returns the exit status. */
int rg_material_command(int argc, char **argv);

#endif
