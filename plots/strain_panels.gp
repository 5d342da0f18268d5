# What the figures of strains.dat share; after `eval answer(table, "facts")`. The script sets curves, their number, and titles;
# `eval strain_panels` then sets what panels.gp needs besides source_of(k) and picked.

note = "strains of the axis and, by bending alone, of the face of the gauge; stress: the largest of the cross-section"
x = "field('crank')"
x_axis = "eval crank_axis(low_crank, high_crank)"
strain_panels = "panels = 3; ".\
    "array axis_of[3] = ['bending strain', 'axial strain', 'stress']; array unit_of[3] = ['µε', 'µε', unit_stress]; ".\
    "array curves_of[3] = [repeated(curves, '1e6*field(\"bending_strain\")'), repeated(curves, '1e6*field(\"axial_strain\")'), ".\
    "repeated(curves, 'field(\"stress\")')]; array titles_of[3] = [titles, titles, titles]"
