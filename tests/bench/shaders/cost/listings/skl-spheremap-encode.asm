pln(16)         g10<1>F         g6<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g12<1>F         g6.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g14<1>F         g7<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g117<1>F        g8<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g119<1>F        g8.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g121<1>F        g9<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
mov(1)          g31<1>D         1090519040D                     { align1 WE_all 1N };
cmp.g.f0.0(16)  null<1>F        g14<8,8,1>F     0xbf800000F  /* -1F */ { align1 1H };
mad(16)         g18<1>F         g31.0<0,1,0>F   g14<4,4,1>F     g31.0<0,1,0>F { align16 1H };
math rsq(16)    g20<1>F         g18<8,8,1>F     null<8,8,1>F    { align1 1H compacted };
mul(16)         g22<1>F         g20<8,8,1>F     0x40000000F  /* 2F */ { align1 1H };
mul(16)         g24<1>F         g10<8,8,1>F     g22<8,8,1>F     { align1 1H compacted };
mul(16)         g26<1>F         g12<8,8,1>F     g22<8,8,1>F     { align1 1H compacted };
(+f0.0) sel(16) g29<1>UD        g24<8,8,1>UD    0x3f800000UD    { align1 1H };
(+f0.0) sel(16) g31<1>UD        g26<8,8,1>UD    0x00000000UD    { align1 1H compacted };
sendsc(16)      nullUD          g0UD            g29UD           0x040b0000                0x00000200
                            render MsgDesc: RT write SIMD16 Surface = 0 mlen 2 ex_mlen 8 rlen 0 { align1 1H };
mov(16)         g30<1>UD        g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g30.2<1>UD      0x00000001UD                    { align1 WE_all 1N compacted };
sendsc(16)      nullUD          g30UD           g10UD           0x040b0001                0x00000200
                            render MsgDesc: RT write SIMD16 Surface = 1 mlen 2 ex_mlen 8 rlen 0 { align1 1H };
mov(16)         g125<1>UD       g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g125.2<1>UD     0x00000002UD                    { align1 WE_all 1N compacted };
sendsc(16)      nullUD          g125UD          g117UD          0x040b1002                0x00000200
                            render MsgDesc: RT write SIMD16 LastRT Surface = 2 mlen 2 ex_mlen 8 rlen 0 { align1 1H EOT };
