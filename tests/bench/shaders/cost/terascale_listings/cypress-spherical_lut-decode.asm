0000 00000004 A03C0000  ALU 16 @8 
 0008 00380400 00346B10     1 x:     INTERP_XY              R1.x,  R0.y, Param0  BS:5
 0010 00B80000 20346B10       y:     INTERP_XY              R1.y,  R0.x, Param0  BS:5
 0012 01380400 4FF46B00       z:     INTERP_XY              __.z,  R0.y, Param0  BS:5
 0014 81B80000 6FF46B00       w:     INTERP_XY              __.w,  R0.x, Param0  BS:5
 0016 001F84FE 800300FC     2 x:     MULADD_IEEE_sat        R0.x,  PV.y, 0.5, 0.5
 0018 000004FE 40200C90       z:     MOV                    R1.z,  PV.y
 0020 801F80FE E00300FC       w:     MULADD_IEEE_sat        R0.w,  PV.x, 0.5, 0.5
 0022 001FA0FE 002300FC     3 x:     MULADD_IEEE            R1.x,  PV.x, [0x437F0000 255.000000], 0.5
 0024 801FACFE 602300FC       w:     MULADD_IEEE            R1.w,  PV.w, [0x437F0000 255.000000], 0.5
 0026 437F0000                                               255.000000 (1132396544)
 0028 00000CFE 20000A10     4 y:     FLOOR                  R0.y,  PV.w
 0030 800000FE 40000A10       z:     FLOOR                  R0.z,  PV.x
 0032 000008FE 20400890     5 y:     TRUNC                  R2.y,  PV.z
 0034 800004FE 60000890       w:     TRUNC                  R0.w,  PV.y
 0036 00000CFE 00202810     6 x:     FLT_TO_INT             R1.x,  PV.w
 0038 800004FE 20202810       y:     FLT_TO_INT             R1.y,  PV.y
0002 00000014 80400000  TEX 1 @40 
 0040 00011203 F01F9000 9C800000   LD             R0.xy__, R1.xy_0,  RID:18, SID:0  CT:NNNN 
0004 00000016 A0040000  ALU 2 @44 
 0044 00000000 00200C90     7 x:     MOV                    R1.x,  R0.x
 0046 80000400 20200C90       y:     MOV                    R1.y,  R0.y
0006 C0008000 95200E88  EXPORT_DONE        PIXEL 0     R1.xyz_      ES:3 EOP 
