"""H-Anim humanoids in X3D and VRML97 (ISO/IEC 19774, and H-Anim 1.0 and 1.1) as glTF."""
