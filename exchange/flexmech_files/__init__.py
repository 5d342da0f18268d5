"""Files of other programs: what flexmech-import reads and flexmech-export writes.

`drawing` is what all formats of linkages have in common, `deck` writes it down. A format has a module with a procedure
`read(text, name)`, which returns a Drawing or raises a FileError; `formats` tells one from another. `linkage_files` finds
the program, `outlines` and `vector_files` are of flexmech-export.
"""
